// drivers/emulators/lms200_words.hpp: the encoding of value words in an LMS200.
#pragma once

#include <cstdint>
#include <optional>

namespace drivers::lms200 {

/// The flags above the distance in a value word, and the range of the codes.
struct WordLayout {
  std::uint16_t top = 0x1FFF;  // the code for no echo
  std::uint16_t field_a = 0;   // flag
  std::uint16_t dazzle = 0;    // flag
};

constexpr unsigned kCodes = 8;  // values below the top that are codes

/// The flags of `measuring_mode`; nullopt for modes without distances.
std::optional<WordLayout> layout_of(std::uint8_t measuring_mode);

/// The packed beam that a receiver must store for `word`.
std::uint16_t beam_of(std::uint16_t word, const WordLayout& layout, bool millimetres);

}  // namespace drivers::lms200
