// server/lab/barn/barn_run.hpp: runs the worlds and scores them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "server/experiment/barn_file.hpp"
#include "server/experiment/oracle.hpp"
#include "server/experiment/table.hpp"
#include "server/experiment/trial.hpp"

namespace server::barn {

/// One run: reached, collided or out of time by the benchmark's rules, with the figures of the
/// judges `metrics`, `barn_score`, `contact` and `place`.
struct Run {
  std::uint64_t world = 0;
  std::uint64_t seed = 0;
  std::string difficulty{};  // of the world
  experiment::Row row{};

  /// The contact with a moving obstacle.
  experiment::Contact contact() const;
};

struct Options {
  Conditions conditions{};
  std::size_t repeats = 1;  // seeds per world
  std::uint64_t first_seed = 1;
  experiment::PoolOptions pool{};
};

struct Result {
  std::size_t worlds = 0;
  algo::Parameters parameters{};  // of the controller, in the first world
  std::vector<Run> runs{};        // the shard's runs, by world, then by seed
};

experiment::Trial trial_of(const World& world, const Conditions& conditions, std::uint64_t seed);

/// Throws std::exception with a sentence if a world cannot be run.
Result run_worlds(const std::vector<World>& worlds, const Options& options);

/// Shares of the runs.
struct Rates {
  std::size_t runs = 0;
  double success = 0, collisions = 0, timeouts = 0;
};
/// The worlds of one difficulty.
struct Bin {
  std::string difficulty{};
  Rates rates{};
};

struct Summary {
  std::size_t worlds = 0;
  Rates rates{};
  double score = 0, score_quarter = 0;                     // means over all runs
  double mean_time = 0;                                    // [s] of the runs that succeeded
  double tick_us_p50 = 0, tick_us_p99 = 0;                 // [us] CPU time of a control tick
  std::size_t avoidable = 0, unavoidable = 0, jumped = 0;  // contacts
};
Summary summarise(const Result& result);
/// In the order of the file; empty if it says nothing of difficulty.
std::vector<Bin> by_difficulty(const Result& result);

/// One row per run: outcome, time, score, clearance, path.
experiment::Table runs_table(const Result& result);
/// One row per run, with every figure.
experiment::Table rows_table(const Result& result);

}  // namespace server::barn
