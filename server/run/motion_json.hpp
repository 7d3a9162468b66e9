// server/run/motion_json.hpp: the moving parts of a scenario: the base's drive and the paths of
// obstacles.
#pragma once

#include <cstddef>

#include <nlohmann/json.hpp>

#include "algo/obstacle_path.hpp"
#include "server/run/json_reader.hpp"
#include "sim/scenario.hpp"

namespace server {

/// Of the path of an obstacle.
inline constexpr std::size_t kMaxPathKeys = 10'000;
inline constexpr double kMaxPathTime = 1e6;  // [s]

/// Throws DocumentError naming the field.
sim::DriveConfig drive_from_json(const JsonReader& in);
nlohmann::json to_json(const sim::DriveConfig& drive);

/// The path of obstacle `id`: {"period","phase"?,"comes_and_goes"?,"keys":[[t,x,y],...]}, times
/// ascending from 0.
algo::ObstaclePath path_from_json(const JsonReader& in);
nlohmann::json to_json(const algo::ObstaclePath& path);

}  // namespace server
