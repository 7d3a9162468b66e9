// server/run/motion_json.hpp: the moving parts of a scenario: the base's drive and the paths of
// obstacles.
#pragma once

#include <nlohmann/json.hpp>

#include "server/run/json_reader.hpp"
#include "sim/scenario.hpp"

namespace server {

/// Throws DocumentError naming the field.
sim::DriveConfig drive_from_json(const JsonReader& in);
nlohmann::json to_json(const sim::DriveConfig& drive);

/// The path of obstacle `id`: {"period","phase"?,"keys":[[t,x,y],...]}, times ascending from 0.
sim::ObstaclePath path_from_json(const JsonReader& in, std::uint32_t id);
nlohmann::json to_json(const sim::ObstaclePath& path);

}  // namespace server
