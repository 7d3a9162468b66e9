// server/run/robot_json.hpp: a robot model as a JSON document (docs/robot-models.md).
#pragma once

#include <nlohmann/json.hpp>

#include "server/run/json_reader.hpp"
#include "sim/robot_model.hpp"

namespace server {

/// Reads a whole model; a missing field takes the Silvermate's value. Throws DocumentError saying
/// which field is wrong and how.
sim::RobotModel robot_from_json(const JsonReader& in);
/// The model without its sensors.
nlohmann::json to_json(const sim::RobotModel& robot);
/// The whole model, as robot_from_json() reads it.
nlohmann::json robot_document(const sim::RobotModel& robot);

}  // namespace server
