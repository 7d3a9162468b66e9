// server/api/openapi.hpp: the description of the API, as it is served.
#pragma once

#include <string>

namespace server {

/// The OpenAPI 3.1 document: openapi.json, and with each operation the answers any request may get
/// (`x-any-operation`) or any that changes something (`x-any-change`).
const std::string& openapi_document();

}  // namespace server
