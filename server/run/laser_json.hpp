// server/run/laser_json.hpp: a laser scanner of a simulated robot as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "server/run/json_reader.hpp"
#include "sim/sensor_configs.hpp"

namespace server {

/// Throws DocumentError.
sim::LaserConfig laser_from_json(const JsonReader& in);
nlohmann::json to_json(const sim::LaserConfig& laser);

}  // namespace server
