// db/residuals.hpp: the two predictions of a block's windows, written once for both directions.
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace db::detail {

// Little-endian on every machine the program runs on; asserted rather than swapped.
static_assert(std::endian::native == std::endian::little);

template <typename T>
T load(std::span<const std::byte> bytes, std::size_t index) {
  T value{};
  std::memcpy(&value, bytes.data() + index * sizeof(T), sizeof(T));
  return value;
}
template <typename T>
void store(std::span<std::byte> bytes, std::size_t index, T value) {
  std::memcpy(bytes.data() + index * sizeof(T), &value, sizeof(T));
}

/// A difference modulo 2^16 with its sign in the last bit, so that small ones of either sign are
/// small numbers.
inline std::uint16_t fold16(std::uint16_t difference) {
  const bool negative = (difference & 0x8000U) != 0;
  const auto doubled = static_cast<std::uint16_t>(difference << 1U);
  return negative ? static_cast<std::uint16_t>(~doubled) : doubled;
}
inline std::uint16_t unfold16(std::uint16_t folded) {
  const auto half = static_cast<std::uint16_t>(folded >> 1U);
  return (folded & 1U) != 0 ? static_cast<std::uint16_t>(~half) : half;
}
inline std::uint32_t fold32(std::uint32_t difference) {
  return (difference & 0x80000000U) != 0 ? ~(difference << 1U) : difference << 1U;
}
inline std::uint32_t unfold32(std::uint32_t folded) {
  return (folded & 1U) != 0 ? ~(folded >> 1U) : folded >> 1U;
}

/// How a window was predicted; the first is used where the frame has no reference.
enum class Choice : std::uint8_t { Within, Reference };

/// What sample `i` is expected to be from its left neighbour.
inline std::uint16_t left_of(std::span<const std::byte> window, std::size_t i) {
  return i == 0 ? std::uint16_t{0} : load<std::uint16_t>(window, i - 1);
}

/// What the bits of float `i` are expected to be: on the line through the same field of the two
/// records before, or as in the reference. 2a is exact, so the line has one rounding and is the
/// same with or without fused arithmetic.
inline std::uint32_t expected_float(std::span<const std::byte> window,
                                    std::span<const std::byte> reference,
                                    std::size_t i,
                                    std::size_t stride,
                                    Choice choice) {
  if (choice == Choice::Reference) return load<std::uint32_t>(reference, i);
  if (i < stride) return 0;
  const auto a = load<std::uint32_t>(window, i - stride);
  if (i < 2 * stride) return a;
  const auto b = load<std::uint32_t>(window, i - 2 * stride);
  const float line = 2.0F * std::bit_cast<float>(a) - std::bit_cast<float>(b);
  return std::isfinite(line) ? std::bit_cast<std::uint32_t>(line) : a;
}

}  // namespace db::detail
