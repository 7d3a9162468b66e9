// server/serve/api/openapi.hpp: the served description of the API.
#pragma once

#include <string>
#include <string_view>

#include "server/serve/net/router.hpp"

namespace server {

/// The OpenAPI 3.1 document: openapi.json, with each operation extended by the answers that any
/// request may get (`x-any-operation`), or any that changes something (`x-any-change`).
const std::string& openapi_document();

/// Makes each described route refuse queries that its description does not name.
void take_described_queries(net::Router& router);

/// server/serve/api/openapi.json, compiled in.
std::string_view embedded_openapi();

}  // namespace server
