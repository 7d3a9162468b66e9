// server/run/embedded_worlds.hpp: the scenarios of sim/worlds, compiled in by embed_worlds.cmake.
#pragma once

#include <span>
#include <string_view>

namespace server {

struct EmbeddedWorld {
  std::string_view name{};
  std::string_view json{};
};

/// In order of name, the demo first.
std::span<const EmbeddedWorld> embedded_worlds();

}  // namespace server
