// server/run/embedded_documents.hpp: what sim/worlds and sim/robots hold, compiled in by
// embed_documents.cmake.
#pragma once

#include <span>
#include <string_view>

namespace server {

struct EmbeddedDocument {
  std::string_view name{};
  std::string_view json{};
};

/// Scenarios in order of name, the demo first.
std::span<const EmbeddedDocument> embedded_worlds();
/// Robot models in order of name.
std::span<const EmbeddedDocument> embedded_robots();

}  // namespace server
