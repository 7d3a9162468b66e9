// server/run/pgm_picture.hpp: grey pictures in the PGM format, as text (P2) or bytes (P5).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace server {

struct GreyPicture {
  std::size_t width = 0, height = 0;
  unsigned most = 0;                  // the value of white
  std::vector<std::uint16_t> grey{};  // by rows from the top
};

inline constexpr std::size_t kMostPixels = 64'000'000;

/// Throws std::runtime_error with a sentence that begins with `name`.
GreyPicture read_pgm(std::string_view bytes, const std::string& name);

}  // namespace server
