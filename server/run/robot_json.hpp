// server/run/robot_json.hpp: a robot model as a JSON document (docs/robot-models.md).
#pragma once

#include <nlohmann/json.hpp>

#include "server/run/json_reader.hpp"
#include "sim/robot_model.hpp"

namespace server {

/// Reads a whole model; what it leaves out is as the Silvermate's. Throws DocumentError saying
/// which field is wrong and how.
sim::RobotModel robot_from_json(const JsonReader& in);
/// All but the sensors.
nlohmann::json to_json(const sim::RobotModel& robot);
/// All of it, as robot_from_json() reads it.
nlohmann::json robot_document(const sim::RobotModel& robot);

}  // namespace server
