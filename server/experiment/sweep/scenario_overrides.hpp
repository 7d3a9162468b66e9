// server/experiment/sweep/scenario_overrides.hpp: what an experiment sets in place of the values of
// every scenario: physics, filter, noise, limits, time.
#pragma once

#include <vector>

#include "server/run/json_reader.hpp"
#include "sim/scenario.hpp"

namespace server::sweep {

/// Reads "physics", "filter", "noise", "limits", "time_limit" and "time_factor" of `in`, where it
/// has them, into the scenarios. Throws DocumentError.
void override_scenarios(const JsonReader& in, std::vector<sim::Scenario>& scenarios);

}  // namespace server::sweep
