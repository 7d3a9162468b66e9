// server/lab/barn/barn_run.hpp: worlds run and scored.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "server/lab/barn/barn_file.hpp"
#include "server/lab/barn/oracle.hpp"

namespace server::barn {

enum class Ending : std::uint8_t { Success, Collision, Timeout };

struct Run {
  std::uint64_t world = 0;
  std::uint64_t seed = 0;
  Ending ending = Ending::Timeout;
  Contact contact = Contact::None;  // in a world where something moves
  double time = 0;                  // [s] from 0.1 m driven to the end
  double score = 0;                 // at most 0.5: editions since 2024
  double score_quarter = 0;         // at most 0.25: 2022 and 2023
  double min_clearance = 0;         // [m] hull to surface
  double path_length = 0;           // [m]
  algo::Pose2 end{};                // true pose
};

struct Options {
  Conditions conditions{};
  std::size_t repeats = 1;  // seeds a world
  std::uint64_t first_seed = 1;
  unsigned workers = 0;  // 0: one a core
  std::function<void(std::size_t done, std::size_t all)> progress{};
};

struct Result {
  std::size_t worlds = 0;
  std::vector<Run> runs{};       // by world, then by seed
  std::vector<float> tick_us{};  // [us] CPU time of every control tick, in no order
};

/// Throws std::exception with a sentence when a world cannot be run.
Result run_worlds(const std::vector<World>& worlds, const Options& options);

struct Summary {
  std::size_t worlds = 0, runs = 0;
  double success = 0, collisions = 0, timeouts = 0;  // shares of the runs
  double score = 0, score_quarter = 0;               // means over all runs
  double mean_time = 0;                              // [s] of the runs that succeeded
  double tick_us_p50 = 0, tick_us_p99 = 0;
  std::size_t avoidable = 0, unavoidable = 0, jumped = 0;  // contacts
};
Summary summarise(const Result& result);

}  // namespace server::barn
