// server/run/robots_json.hpp: the other robots of a scenario as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "server/run/json_reader.hpp"
#include "server/run/robot_library.hpp"
#include "sim/scenario.hpp"

namespace server {

/// [{"start","robot"?,"goal"?,"waypoints"?,"controller"?,"filter"?,"parameters"?}, ...] of the
/// document `in`. The rest of `scenario` must have been read: a robot given by name, or by a model
/// without sensors, takes the scenario's sensors. Throws DocumentError.
void read_robots(const JsonReader& in, const RobotLibrary& robots, sim::Scenario& scenario);

/// Writes the same field into `out` if there are other robots.
void write_robots(const sim::Scenario& s, nlohmann::json& out);

}  // namespace server
