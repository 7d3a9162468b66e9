// server/run/scenario_json.hpp: scenarios and their parameters as JSON documents
// (docs/interfaces.md).
#pragma once

#include <cstddef>
#include <string>

#include <nlohmann/json.hpp>

#include "algo/parameters.hpp"
#include "server/run/obstacle_json.hpp"
#include "sim/scenario.hpp"

namespace server {

constexpr std::size_t kMaxObstacles = 2000;

/// Reads a whole scenario; throws DocumentError saying which field is wrong and how. Names of
/// controllers and filters are checked, overlaps with the robot are not (the world does that).
sim::Scenario scenario_from_json(const nlohmann::json& document);
nlohmann::json to_json(const sim::Scenario& scenario);

nlohmann::json to_json(const algo::Parameters& parameters);

/// `{"k_r":0.6}` on top of `base`; throws DocumentError on an unknown name, a value out of limits
/// or a set that together is unsafe.
algo::Parameters parameters_from_json(const nlohmann::json& value,
                                      const std::string& path,
                                      const algo::Parameters& base);

/// Whether `name` may name a scenario: [a-z0-9_-], 1 to 64 characters.
bool valid_scenario_name(std::string_view name);

}  // namespace server
