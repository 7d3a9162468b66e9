// server/serve/foxglove/schemas.hpp: the message schemas built into the program; their texts are
// generated at build time from npm's @foxglove/schemas, web/telemetry.fbs and state.schema.json.
#pragma once

#include <span>
#include <string_view>

namespace server::foxglove {

struct Schema {
  std::string_view name{};      // "foxglove.LaserScan", "tautline.State", "tautline.wire.Frame"
  std::string_view encoding{};  // "jsonschema" or "flatbuffer"
  std::string_view text{};      // JSON Schema, or base64 of the binary FlatBuffers schema
};

/// All schemas, sorted by name.
std::span<const Schema> schemas();

/// The schema of that name. Throws std::out_of_range if there is none.
const Schema& schema(std::string_view name);

}  // namespace server::foxglove
