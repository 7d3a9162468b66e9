// server/lab/crowd/crowd_scenario.hpp: a recording of people as a scenario.
#pragma once

#include "server/lab/crowd/people_file.hpp"
#include "sim/scenario.hpp"

namespace server::crowd {

/// The first crossing of `recording` as a scenario in which people come, walk and go as recorded;
/// the page makes the same one of the same file (web/src/edit/people_file.ts). `robot` gives robot,
/// sensors, controller and parameters. Nobody is in it who is seen once only, or who stands within
/// kLeftOut of the robot at the beginning. When the recording is over it begins anew. Throws
/// std::runtime_error with a sentence if the recording is too small or too long for a scenario,
/// or holds nobody who walks, or more people or places than a scenario takes.
sim::Scenario scenario_of(const Recording& recording, const sim::Scenario& robot);

}  // namespace server::crowd
