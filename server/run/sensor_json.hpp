// server/run/sensor_json.hpp: the sensors of a scenario besides its laser scanners, as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "server/run/json_reader.hpp"
#include "sim/scenario.hpp"

namespace server {

/// `sonar`, `infrared`, `gyro`, `bumpers`, `encoders`, and what the odometry is made of,
/// `localization`, where the document `in` has them. Throws DocumentError.
void read_sensors(const JsonReader& in, sim::Scenario& scenario);

/// The same fields into `out`, but for those that are as a scenario has them anyway.
void write_sensors(const sim::Scenario& s, nlohmann::json& out);

}  // namespace server
