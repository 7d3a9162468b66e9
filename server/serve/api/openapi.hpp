// server/serve/api/openapi.hpp: the description of the API, as it is served.
#pragma once

#include <string>
#include <string_view>

namespace server {

/// The OpenAPI 3.1 document: openapi.json, and with each operation the answers any request may get
/// (`x-any-operation`) or any that changes something (`x-any-change`).
const std::string& openapi_document();

/// server/serve/api/openapi.json, compiled in.
std::string_view embedded_openapi();

}  // namespace server
