// server/lab/soak/operator_study.hpp: `tautline soak --operator`: the guard of a driver's stick
// against an operator who tries to hit something, in many indoor worlds.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "server/experiment/pool.hpp"
#include "server/experiment/table.hpp"
#include "server/lab/soak/operator_drive.hpp"
#include "server/lab/soak/tight_places.hpp"
#include "sim/scenario.hpp"

namespace server::soak {

/// A hull with its sensors.
struct Driven {
  std::string name{};  // "jackal", "silvermate_sonars"
  sim::RobotModel robot{};
  std::string controller = "modified";  // one that the robot's sensors suffice for
};
/// Every built-in robot with its scanner, and the round one with a ring of sonars instead.
std::vector<Driven> driven_robots();

struct OperatorOptions {
  std::uint64_t worlds = 100;
  std::uint64_t first_seed = 1;
  double seconds = 10'000;  // of each robot and hand, in all worlds together
  sim::PhysicsKind physics = sim::PhysicsKind::Bullet;
  std::vector<Driven> robots = driven_robots();
  experiment::PoolOptions pool{};
};

/// One world, driven by every hand with the same stick.
struct DrivenWorld {
  std::uint64_t seed = 0;
  std::string robot{};
  std::array<Drive, kHands.size()> drives{};
};

struct OperatorStudy {
  std::vector<DrivenWorld> worlds{};  // by robot, then by seed
  /// Of each robot, in order; left out in a shard, but for the first.
  std::vector<std::pair<std::string, TightPlaces>> places{};
};

/// The same options give the same study with any number of threads.
OperatorStudy run_operator(const OperatorOptions& options);

/// Contacts with what was seen, in a mode with a guard. They must not happen.
int counted_contacts(const OperatorStudy& study);
/// Guarded's distance ahead as a share of raw's, in halls; NaN without halls.
double share_ahead(const OperatorStudy& study, const std::string& robot);

/// A row for each robot and hand.
experiment::Table operator_table(const OperatorStudy& study);
/// A row for each robot: doors, walls and the share of raw's distance.
experiment::Table places_table(const OperatorStudy& study);
/// A row for each world, robot and hand.
experiment::Table operator_rows(const OperatorStudy& study);

}  // namespace server::soak
