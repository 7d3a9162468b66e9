// server/foxglove/embedded_schemas.hpp: documents compiled in by embed_schemas.mjs.
#pragma once

#include <string_view>

namespace server {

/// JSON schema text of a published type, "foxglove.LaserScan"; empty when it was not embedded.
std::string_view foxglove_schema(std::string_view name);
/// Binary schema of web/telemetry.fbs, base64, as the Foxglove protocol wants it.
std::string_view telemetry_bfbs_base64();
/// The OpenAPI 3.1 document of the REST API.
std::string_view embedded_openapi();

}  // namespace server
