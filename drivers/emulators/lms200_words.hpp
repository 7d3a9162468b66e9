// drivers/emulators/lms200_words.hpp: the value words of an LMS200, as the device makes them.
#pragma once

#include <cstdint>
#include <optional>

namespace drivers::lms200 {

/// What is above the distance in a value word, and where the codes lie.
struct WordLayout {
  std::uint16_t top = 0x1FFF;  // the code for no echo
  std::uint16_t field_a = 0;   // flag
  std::uint16_t dazzle = 0;    // flag
};

constexpr unsigned kCodes = 8;  // below the top there are codes, no distances

/// Of measuring mode `measuring_mode`; nothing where it sends no distances.
std::optional<WordLayout> layout_of(std::uint8_t measuring_mode);

/// Word `word` as a receiver is to keep it.
std::uint16_t beam_of(std::uint16_t word, const WordLayout& layout, bool millimetres);

}  // namespace drivers::lms200
