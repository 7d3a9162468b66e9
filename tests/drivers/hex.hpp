// tests/drivers/hex.hpp: bytes in the manuals' notation.
#pragma once

#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include "drivers/bytes.hpp"

namespace drivers {

using Bytes = std::vector<std::uint8_t>;

/// "02 80 FF" as three bytes; "21x00" stands for 21 zeros.
inline Bytes hex(const std::string& text) {
  Bytes bytes;
  std::istringstream words(text);
  std::string word;
  while (words >> word) {
    const std::size_t times = word.find('x');
    const std::size_t count = times == std::string::npos ? 1 : std::stoul(word.substr(0, times));
    const std::string digits = times == std::string::npos ? word : word.substr(times + 1);
    bytes.insert(bytes.end(), count, static_cast<std::uint8_t>(std::stoul(digits, nullptr, 16)));
  }
  return bytes;
}

inline Bytes bytes_of(ByteView view) {
  return {view.begin(), view.end()};
}

inline void append(Bytes& to, const Bytes& more) {
  to.insert(to.end(), more.begin(), more.end());
}

}  // namespace drivers
