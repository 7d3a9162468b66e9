// drivers/text.hpp: printf-style formatting to std::string.
#pragma once

#include <array>
#include <cstdio>
#include <string>

namespace drivers {

/// The output of printf(), cut after 239 characters.
template <typename... Args>
std::string format(const char* pattern, Args... args) {
  std::array<char, 240> text{};
  std::snprintf(text.data(), text.size(), pattern, args...);
  return text.data();
}

}  // namespace drivers
