// server/lab/reproduce/session_reach.hpp: the reaches of random worlds as runs of a robot with an
// arm: Bullet, scanners, odometry, guard and gate.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "server/experiment/pool.hpp"
#include "server/lab/reproduce/reach_study.hpp"
#include "sim/scenario.hpp"

namespace server::reproduce {

/// `world` with its pieces declared, for `silvermate_arm`.
sim::Scenario reach_scenario(const ReachWorld& world);

/// One run of it from start to outcome. Clearances are true ones.
Reach session_reach_in(const ReachWorld& world, std::uint64_t seed);

/// `worlds` with a reachable goal of each scene, as runs.
ReachStudy study_session_reach(std::size_t worlds, const experiment::PoolOptions& options);

std::string to_text(const ReachStudy& study);
nlohmann::json to_json(const ReachStudy& study);

}  // namespace server::reproduce
