// server/lab/soak/soak.hpp: many random worlds, and the faults that must never happen in any.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "server/experiment/table.hpp"
#include "server/experiment/trial.hpp"

namespace server::soak {

struct Options {
  std::uint64_t worlds = 1000;
  std::uint64_t first_seed = 1;
  std::string controller = "strip";
  experiment::PoolOptions pool{};
};

/// One world, run until the goal, until the robot has stood still for long, or for 300 s. The
/// figures are those of the judges `metrics`, `silence` and `place`; the reason is the robot's last
/// sentence.
struct World {
  std::uint64_t seed = 0;
  bool has_way = false;  // in the true world, with 10 cm to spare
  experiment::Row row{};
};

/// The ending as the table counts it: "reached", "gave a reason", "out of time", and the faults
/// "silent", "collision", "not finite".
std::string_view ending(const experiment::Row& row);
bool is_fault(const experiment::Row& row);

experiment::Trial trial_of(std::uint64_t seed, const std::string& controller);

/// The worlds of the shard in order of seed, with any number of threads.
std::vector<World> run_worlds(const Options& options);

/// One row per ending, with its number of worlds.
experiment::Table endings_table(const std::vector<World>& worlds);
/// One row per world, with every figure.
experiment::Table rows_table(const std::vector<World>& worlds);

}  // namespace server::soak
