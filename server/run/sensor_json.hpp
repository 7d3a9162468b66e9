// server/run/sensor_json.hpp: the sensors of a simulated robot as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "server/run/json_reader.hpp"
#include "sim/sensor_configs.hpp"

namespace server {

/// `lasers`, `sonar`, `infrared`, `sensors`, `gyro`, `bumpers` and `encoders` where the document
/// `in` has them; the others keep their values. Throws DocumentError.
void read_sensors(const JsonReader& in, sim::Sensors& sensors);

/// Writes the same fields into `out`: the lasers always, the others only where they differ from the
/// default.
void write_sensors(const sim::Sensors& s, nlohmann::json& out);
bool same_sensors(const sim::Sensors& a, const sim::Sensors& b);

}  // namespace server
