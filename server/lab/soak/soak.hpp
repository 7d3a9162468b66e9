// server/lab/soak/soak.hpp: many random worlds, and what must never happen in any.
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

/// One world: until the goal, until the robot has stood for long, or 300 s. The figures are those
/// of the judges `metrics`, `silence` and `place`; the reason is what the robot said last.
struct World {
  std::uint64_t seed = 0;
  bool has_way = false;  // in truth, with 10 cm to spare
  experiment::Row row{};
};

/// How it ended, as the table counts it: "reached", "gave a reason", "out of time", and what must
/// never be: "silent", "collision", "not finite".
std::string_view ending(const experiment::Row& row);
bool is_fault(const experiment::Row& row);

experiment::Trial trial_of(std::uint64_t seed, const std::string& controller);

/// In the order of the seeds, whatever the threads; those of the shard.
std::vector<World> run_worlds(const Options& options);

/// An ending a line, and in how many worlds it came.
experiment::Table endings_table(const std::vector<World>& worlds);
/// A world a line with every figure.
experiment::Table rows_table(const std::vector<World>& worlds);

}  // namespace server::soak
