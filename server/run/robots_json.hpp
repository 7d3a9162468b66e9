// server/run/robots_json.hpp: the other robots of a scenario as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "server/run/json_reader.hpp"
#include "server/run/robot_library.hpp"
#include "sim/scenario.hpp"

namespace server {

/// [{"start","robot"?,"goal"?,"waypoints"?,"controller"?,"filter"?,"parameters"?}, ...] of the
/// document `in`. All else of `scenario` has been read; its sensors are also those of a robot whose
/// model is given by name, or without sensors. Throws DocumentError.
void read_robots(const JsonReader& in, const RobotLibrary& robots, sim::Scenario& scenario);

/// The same field into `out`, where there are any.
void write_robots(const sim::Scenario& s, nlohmann::json& out);

}  // namespace server
