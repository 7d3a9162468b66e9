// db/samples.cpp: predicts the ranges of a scan.
#include "db/samples.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace db::detail {
namespace {

// The program's machines are all little-endian; asserted rather than swapped.
static_assert(std::endian::native == std::endian::little);

std::uint16_t load(std::span<const std::byte> window, std::size_t i) {
  std::uint16_t value = 0;
  std::memcpy(&value, window.data() + i * sizeof(value), sizeof(value));
  return value;
}

/// Moves the sign of a difference modulo 2^16 to the last bit, so that small differences of either
/// sign are small numbers.
std::uint16_t fold(std::uint16_t difference) {
  const bool negative = (difference & 0x8000U) != 0;
  const auto doubled = static_cast<std::uint16_t>(difference << 1U);
  return negative ? static_cast<std::uint16_t>(~doubled) : doubled;
}
std::uint16_t unfold(std::uint16_t folded) {
  const auto half = static_cast<std::uint16_t>(folded >> 1U);
  return (folded & 1U) != 0 ? static_cast<std::uint16_t>(~half) : half;
}

/// Predicts sample `i`: without a reference by its left neighbour; if that and the reference see
/// one surface, by their mean, which is less noisy than either; else by the reference.
std::uint16_t expected_sample(std::uint16_t left,
                              std::span<const std::byte> reference,
                              std::size_t i) {
  constexpr int kSameSurface = 24;  // [mm]
  if (reference.empty()) return left;
  const std::uint16_t there = load(reference, i);
  const int apart = int{left} - int{there};
  const bool same = apart <= kSameSurface && apart >= -kSameSurface;
  return static_cast<std::uint16_t>(same ? (left + there) / 2 : there);
}

std::uint16_t residual(std::span<const std::byte> samples,
                       std::span<const std::byte> reference,
                       std::size_t i) {
  const std::uint16_t left = i == 0 ? std::uint16_t{0} : load(samples, i - 1);
  const std::uint16_t expected = expected_sample(left, reference, i);
  return fold(static_cast<std::uint16_t>(load(samples, i) - expected));
}

/// Residual bits of every fourth sample: enough to choose by.
std::size_t cost(std::span<const std::byte> samples, std::span<const std::byte> reference) {
  const std::size_t count = samples.size() / sizeof(std::uint16_t);
  std::size_t bits = 0;
  for (std::size_t i = 1; i < count; i += 4) {
    bits += static_cast<std::size_t>(std::bit_width(residual(samples, reference, i)));
  }
  return bits;
}

}  // namespace

Choice write_samples(std::span<const std::byte> samples,
                     std::span<const std::byte> reference,
                     Streams& streams) {
  const bool refers = !reference.empty() && cost(samples, reference) < cost(samples, {});
  if (!refers) reference = {};
  const std::size_t count = samples.size() / sizeof(std::uint16_t);
  const std::size_t before = streams[kLow].size();
  streams[kLow].resize(before + count);
  streams[kHigh].resize(before + count);
  std::uint8_t* const low = streams[kLow].data() + before;
  std::uint8_t* const high = streams[kHigh].data() + before;
  const auto put = [&](std::size_t i, std::uint16_t folded) {
    low[i] = static_cast<std::uint8_t>(folded & 0xFFU);
    high[i] = static_cast<std::uint8_t>(folded >> 8U);
  };
  if (count > 0) put(0, residual(samples, reference, 0));
  // Folds many before splitting their bytes: the compiler cannot vectorise both in one loop.
  std::array<std::uint16_t, 64> folded{};
  for (std::size_t first = 1; first < count; first += folded.size()) {
    const std::size_t some = std::min(folded.size(), count - first);
    for (std::size_t k = 0; k < some; ++k) folded[k] = residual(samples, reference, first + k);
    for (std::size_t k = 0; k < some; ++k) put(first + k, folded[k]);
  }
  return refers ? Choice::Reference : Choice::Within;
}

void read_samples(std::span<std::byte> samples,
                  std::span<const std::byte> reference,
                  const Streams& streams,
                  std::size_t& at) {
  const std::size_t count = samples.size() / sizeof(std::uint16_t);
  if (streams[kLow].size() - at < count) {
    throw CodecError("the block's streams do not match its layout");
  }
  const std::uint8_t* const low = streams[kLow].data() + at;
  const std::uint8_t* const high = streams[kHigh].data() + at;
  std::uint16_t left = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto folded = static_cast<std::uint16_t>(low[i] | (high[i] * 256U));
    left = static_cast<std::uint16_t>(unfold(folded) + expected_sample(left, reference, i));
    std::memcpy(samples.data() + i * sizeof(left), &left, sizeof(left));
  }
  at += count;
}

}  // namespace db::detail
