// server/run/ground_json.hpp: the part of a robot's recorded specification that its ground senses
// and its limits on the ground need, so that a stored run replays with them.
#pragma once

#include <nlohmann/json.hpp>

#include "algo/robot.hpp"
#include "server/run/json_reader.hpp"

namespace server {

/// Adds `axle`, `inclinometer`, `stance`, `line_camera`, `floor_sensors` and `climbs` to `out`, in
/// metres, radians and pixels, each only if the robot has it.
void write_ground(const algo::RobotSpec& robot, nlohmann::json& out);

/// Reads them without limits: values that a run was once accepted with are read unchanged. Throws
/// DocumentError.
void read_ground(const JsonReader& in, algo::RobotSpec& robot);

}  // namespace server
