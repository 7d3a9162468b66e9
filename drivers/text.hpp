// drivers/text.hpp: sentences with figures in them.
#pragma once

#include <array>
#include <cstdio>
#include <string>

namespace drivers {

/// What printf() would print, cut after 239 characters.
template <typename... Args>
std::string format(const char* pattern, Args... args) {
  std::array<char, 240> text{};
  std::snprintf(text.data(), text.size(), pattern, args...);
  return text.data();
}

}  // namespace drivers
