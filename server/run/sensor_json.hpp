// server/run/sensor_json.hpp: the sensors of a simulated robot as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "server/run/json_reader.hpp"
#include "sim/sensor_configs.hpp"

namespace server {

/// `lasers`, `sonar`, `infrared`, `sensors`, `gyro`, `bumpers` and `encoders` where the document
/// `in` has them; the others stay. Throws DocumentError.
void read_sensors(const JsonReader& in, sim::Sensors& sensors);

/// The same fields into `out`; all but the lasers only where they are not as usual.
void write_sensors(const sim::Sensors& s, nlohmann::json& out);
bool same_sensors(const sim::Sensors& a, const sim::Sensors& b);

}  // namespace server
