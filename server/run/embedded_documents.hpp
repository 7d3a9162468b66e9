// server/run/embedded_documents.hpp: the documents of sim/worlds and sim/robots, compiled in by
// embed_documents.cmake.
#pragma once

#include <span>
#include <string_view>

namespace server {

struct EmbeddedDocument {
  std::string_view name{};
  std::string_view json{};
};

/// Scenarios sorted by name, except that the demo comes first.
std::span<const EmbeddedDocument> embedded_worlds();
/// Robot models sorted by name.
std::span<const EmbeddedDocument> embedded_robots();

}  // namespace server
