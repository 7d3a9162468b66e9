// drivers/bytes.hpp: short byte strings without the heap, and words of two or four bytes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace drivers {

/// Bytes of a device's line; valid as long as the buffer they point into.
using ByteView = std::span<const std::uint8_t>;

/// Up to N bytes in place. Further bytes are dropped, so choose N for the longest message.
template <std::size_t N>
class FixedBytes {
 public:
  void push_back(std::uint8_t byte) {
    if (size_ < N) bytes_[size_++] = byte;
  }
  void append(ByteView more) {
    for (const std::uint8_t byte : more) push_back(byte);
  }
  void append(std::string_view text) {
    for (const char c : text) push_back(static_cast<std::uint8_t>(c));
  }
  /// `word`, low byte first.
  void append_word(std::uint16_t word) {
    push_back(static_cast<std::uint8_t>(word & 0xFFU));
    push_back(static_cast<std::uint8_t>(word >> 8U));
  }
  void clear() { size_ = 0; }
  std::size_t size() const { return size_; }
  ByteView view() const { return ByteView(bytes_).first(size_); }
  std::string_view text() const { return {reinterpret_cast<const char*>(bytes_.data()), size_}; }

 private:
  std::array<std::uint8_t, N> bytes_{};
  std::size_t size_ = 0;
};

/// The word at `at`, low byte first; `at` + 2 bytes must be there.
inline std::uint16_t word_at(ByteView bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] | (bytes[at + 1] << 8U));
}
inline std::int16_t signed_word_at(ByteView bytes, std::size_t at) {
  return static_cast<std::int16_t>(word_at(bytes, at));
}

/// `bytes` as the characters they are.
inline std::string_view text_of(ByteView bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// `value` rounded to an integer, clamped to +-`limit`; NaN becomes 0, which stops.
inline int rounded(double value, int limit) {
  if (std::isnan(value)) return 0;
  return static_cast<int>(std::lround(std::clamp<double>(value, -limit, limit)));
}

}  // namespace drivers
