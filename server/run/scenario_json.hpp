// server/run/scenario_json.hpp: scenarios and their parameters as JSON documents
// (docs/interfaces.md).
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "algo/parameters.hpp"
#include "server/run/json_reader.hpp"
#include "server/run/obstacle_json.hpp"
#include "server/run/robot_library.hpp"
#include "sim/scenario.hpp"

namespace server {

constexpr std::size_t kMaxObstacles = 2000;

/// Reads a whole scenario; throws DocumentError saying which field is wrong and how. Checks the
/// names of controllers, filters and robots. The world checks overlaps with the robot.
sim::Scenario scenario_from_json(const nlohmann::json& document,
                                 const RobotLibrary& robots = RobotLibrary());
nlohmann::json to_json(const sim::Scenario& scenario);

/// The physics of that name. Throws DocumentError about `path`.
sim::PhysicsKind physics_named(const std::string& name, const std::string& path);
/// The field "physics" of a scenario or a request, or its older name "vehicle". Throws
/// DocumentError.
std::optional<sim::PhysicsKind> physics_from_json(const JsonReader& in);

nlohmann::json to_json(const algo::Parameters& parameters);

/// `{"k_r":0.6}` on top of `base`; throws DocumentError on an unknown name, a value out of limits,
/// or a set of values that is unsafe together.
algo::Parameters parameters_from_json(const nlohmann::json& value,
                                      const std::string& path,
                                      const algo::Parameters& base);

}  // namespace server
