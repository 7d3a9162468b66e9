// server/embedded_documents.hpp: the scenarios of sim/worlds, those of the paper and the API's
// description, compiled in by embed_documents.cmake.
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

/// The OpenAPI 3.1 document of the REST API.
std::string_view embedded_openapi();

/// server/reproduce/paper.json: layouts, conditions and limits that `tautline reproduce` holds.
std::string_view embedded_paper();

}  // namespace server
