// drivers/emulators/lms200_words.cpp: the measuring modes of the manual.
#include "drivers/emulators/lms200_words.hpp"

#include <algorithm>

#include "algo/laser_scan.hpp"

namespace drivers::lms200 {

std::optional<WordLayout> layout_of(std::uint8_t measuring_mode) {
  switch (measuring_mode) {
    case 0x00:
      return WordLayout{.top = 0x1FFF, .field_a = 0x2000, .dazzle = 0x8000};
    case 0x01:
      return WordLayout{.top = 0x1FFF};
    case 0x02:
      return WordLayout{.top = 0x1FFF, .field_a = 0x2000};
    case 0x03:
      return WordLayout{.top = 0x3FFF};
    case 0x04:
      return WordLayout{.top = 0x3FFF, .field_a = 0x4000};
    case 0x05:
    case 0x0F:  // the manual does not give its codes: those of the other 32 m modes
      return WordLayout{.top = 0x7FFF};
    case 0x06:
      return WordLayout{.top = 0x7FFF, .field_a = 0x8000};
    default:
      return std::nullopt;
  }
}

std::uint16_t beam_of(std::uint16_t word, const WordLayout& layout, bool millimetres) {
  const unsigned value = word & layout.top;
  if (value + kCodes < layout.top) {
    return static_cast<std::uint16_t>(
        std::min<unsigned>(millimetres ? value : 10 * value, algo::kPackedMaxRange));
  }
  const unsigned digit = value & 0xFU;
  if (digit == static_cast<unsigned>(algo::BeamCode::BeyondRange)) return algo::kPackedFree;
  return static_cast<std::uint16_t>(algo::kPackedCodeBase + digit);
}

}  // namespace drivers::lms200
