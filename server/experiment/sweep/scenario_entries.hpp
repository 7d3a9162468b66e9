// server/experiment/sweep/scenario_entries.hpp: the list of scenarios of an experiment: names of
// the library, whole scenarios, generators of random layouts, and BARN worlds.
#pragma once

#include <vector>

#include "server/experiment/sweep/sweep_document.hpp"
#include "server/run/json_reader.hpp"
#include "server/run/scenario_library.hpp"
#include "sim/scenario.hpp"

namespace server::sweep {

/// Checks the field "scenarios" of `in` but for the scenarios themselves, and counts them. Throws
/// DocumentError.
double count_scenarios(const JsonReader& in, Files files);

/// The scenarios, in order; each has a goal and a name of its own. Throws DocumentError.
std::vector<sim::Scenario> scenarios_from_json(const JsonReader& in,
                                               const ScenarioLibrary& library,
                                               Files files);

}  // namespace server::sweep
