// server/lab/buildings/building_study.hpp: drives to goals in random buildings and compares the
// ends with the truth.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "algo/metrics.hpp"
#include "server/experiment/table.hpp"
#include "server/experiment/trial.hpp"
#include "server/lab/buildings/building_world.hpp"

namespace server::buildings {

struct Options {
  std::uint64_t first_seed = 0;
  std::uint64_t last_seed = 199;  // the last one too
  std::vector<Kind> kinds{};      // empty: all
  std::string controller = "strip";
  experiment::PoolOptions pool{};
};

/// The seeds of the wanted kinds.
std::vector<std::uint64_t> seeds_of(const Options& options);

/// The first of the chosen buildings, with the time limit of its run. Throws std::invalid_argument
/// if none is chosen.
sim::Scenario first_scenario(const Options& options);

/// How a run ended.
enum class End : std::uint8_t {
  Reached,
  Refused,  // it stood for long, saying that there is no way, or that the goal is taken
  Blocked,  // it stood for long with another reason
  Silent,   // it stood for long without a reason
  Collided,
  OutOfTime,  // it still moved when the time was over
};
/// "out_of_time"
std::string_view name(End end);
/// Whether there is a way to the goal, as a word of a table.
std::string_view way_word(const Truth& truth);
/// `silent`: it stood without a reason. `state`: of the strip at the end, as its words explain it.
End end_of(algo::Outcome outcome, bool silent, int state);

inline constexpr double kStandsLong = 60;  // [s] longer than a door stays shut
/// [s] after which a run is over.
double limit_of(const Truth& truth);

struct BuildingRun {
  std::uint64_t seed = 0;
  Building building{};  // without its obstacles
  Truth truth{};
  experiment::Row row{};

  End end() const;
};

experiment::Trial trial_of(std::uint64_t seed, const Building& building, const Truth& truth);

/// The runs of the shard in order of seed, with any number of threads.
std::vector<BuildingRun> run_buildings(const Options& options);

/// The figures of some of the runs.
struct BuildingFigures {
  std::size_t runs = 0;
  std::size_t with_way = 0, without_way = 0;  // those too close to call are in neither
  std::size_t reached = 0;                    // of those with a way
  std::size_t refused = 0;                    // of those with a way: Refused, Blocked or Silent
  std::size_t late = 0;                       // of those with a way: OutOfTime
  std::size_t said = 0;                       // of those without: Refused
  std::size_t collisions = 0;                 // of all
  double ratio_median = 0, ratio_p95 = 0;     // time over the oracle's, of those reached; NaN: none
};
BuildingFigures figures_of(const std::vector<const BuildingRun*>& runs);

/// One row per kind, per width of the doors, and for all.
experiment::Table figures_table(const std::vector<BuildingRun>& runs);
/// One row per run, with every figure.
experiment::Table rows_table(const std::vector<BuildingRun>& runs);
/// The runs that did not end as the truth demands.
experiment::Table faults_table(const std::vector<BuildingRun>& runs);
nlohmann::json to_json(const std::vector<BuildingRun>& runs);

/// [us] CPU time of a control tick.
struct TickTimes {
  double p50 = 0, p99 = 0;
};
TickTimes tick_times(const std::vector<BuildingRun>& runs);

}  // namespace server::buildings
