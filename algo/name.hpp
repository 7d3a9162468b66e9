// algo/name.hpp: a short word held by value, without a table of names or a lifetime to observe.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>
#include <string_view>

namespace algo {

/// "stale_scan", "avoid", "air.temperature", as REST, CSV and the wire spell it.
class Name {
 public:
  static constexpr std::size_t kLongest = 31;

  constexpr Name() = default;
  /// Throws std::length_error when `text` is longer than kLongest.
  constexpr Name(std::string_view text) {  // NOLINT(google-explicit-constructor)
    if (text.size() > kLongest) throw std::length_error("A name has 31 letters at most.");
    std::ranges::copy(text, text_.begin());
    size_ = static_cast<unsigned char>(text.size());
  }
  constexpr Name(const char* text)  // NOLINT(google-explicit-constructor)
      : Name(std::string_view(text)) {}

  constexpr std::string_view view() const { return {text_.data(), size_}; }
  constexpr bool empty() const { return size_ == 0; }
  friend constexpr bool operator==(const Name& a, const Name& b) { return a.view() == b.view(); }

 private:
  std::array<char, kLongest> text_{};
  unsigned char size_ = 0;
};

}  // namespace algo
