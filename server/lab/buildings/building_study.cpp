// server/lab/buildings/building_study.cpp: runs buildings as trials and summarises their rows.
#include "server/lab/buildings/building_study.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "algo/full_strip/full_strip_controller.hpp"
#include "server/experiment/statistics.hpp"

namespace server::buildings {
namespace {

using algo::Outcome;

constexpr double kLeastLimit = 120;     // [s] of a run with a way to its goal,
constexpr double kMostRatio = 6;        // or so many times the oracle's time
constexpr double kWithoutLimit = 2400;  // [s] of a run without a way: 1.2 km of lanes
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

constexpr std::array<std::string_view, 6> kEndNames{
    "reached", "refused", "blocked", "silent", "collided", "out_of_time"};

using Choice = std::function<bool(const BuildingRun&)>;

std::vector<const BuildingRun*> chosen(const std::vector<BuildingRun>& runs, const Choice& choice) {
  std::vector<const BuildingRun*> out;
  for (const BuildingRun& run : runs) {
    if (choice(run)) out.push_back(&run);
  }
  return out;
}

/// Calls `visit(name, runs)` for each kind, each width of the doors, and all.
template <typename Visit>
void each_group(const std::vector<BuildingRun>& runs, Visit&& visit) {
  for (const Kind kind : kKinds) {
    visit(std::string(name(kind)),
          chosen(runs, [&](const BuildingRun& run) { return run.building.kind == kind; }));
  }
  for (const double width : kDoorWidths) {
    visit(fmt::format("doors {:.2f} m", width),
          chosen(runs, [&](const BuildingRun& run) { return run.building.door_width == width; }));
  }
  visit("all, doors 0.80 m and more",
        chosen(runs, [](const BuildingRun& run) { return run.building.door_width >= 0.8; }));
  visit("all", chosen(runs, [](const BuildingRun&) { return true; }));
}

bool as_the_truth_demands(const BuildingRun& run) {
  if (run.end() == End::Collided || run.end() == End::Silent) return false;
  if (run.truth.has_way) return run.end() == End::Reached;
  return !run.truth.has_none || run.end() == End::Refused;
}

std::string share(std::size_t part, std::size_t whole) {
  return whole == 0 ? ""
                    : fmt::format("{:.1f}",
                                  100.0 * static_cast<double>(part) / static_cast<double>(whole));
}

std::string number(double value) {
  return std::isnan(value) ? "" : fmt::format("{:.2f}", value);
}

}  // namespace

std::string_view way_word(const Truth& truth) {
  return truth.has_way ? "yes" : (truth.has_none ? "no" : "too close to call");
}

std::vector<std::uint64_t> seeds_of(const Options& options) {
  std::vector<std::uint64_t> seeds;
  for (std::uint64_t seed = options.first_seed; seed <= options.last_seed; ++seed) {
    const Kind kind = kKinds.at(seed % kKinds.size());
    const bool wanted =
        options.kinds.empty() || std::ranges::find(options.kinds, kind) != options.kinds.end();
    if (wanted) seeds.push_back(seed);
  }
  return seeds;
}

sim::Scenario first_scenario(const Options& options) {
  const std::vector<std::uint64_t> seeds = seeds_of(options);
  if (seeds.empty()) throw std::invalid_argument("no building has these seeds and kinds");
  Building building = building_of(seeds.front(), options.controller);
  building.scenario.time_limit = limit_of(truth_of(building));
  return std::move(building.scenario);
}

std::string_view name(End end) {
  return kEndNames.at(static_cast<std::size_t>(end));
}

End end_of(Outcome outcome, bool silent, int state) {
  switch (outcome) {
    case Outcome::Reached:
      return End::Reached;
    case Outcome::Collided:
      return End::Collided;
    case Outcome::Stuck: {
      if (silent) return End::Silent;
      const bool refused = state == algo::FullStripController::kNoWay ||
                           state == algo::FullStripController::kGoalTaken;
      return refused ? End::Refused : End::Blocked;
    }
    default:
      return End::OutOfTime;
  }
}

End BuildingRun::end() const {
  const bool stuck = row.outcome == Outcome::Stuck;
  return end_of(
      row.outcome, stuck && row["silent"] > 0, stuck ? static_cast<int>(row["end_state"]) : 0);
}

double limit_of(const Truth& truth) {
  return truth.time ? std::max(kLeastLimit, kMostRatio * *truth.time) : kWithoutLimit;
}

experiment::Trial trial_of(std::uint64_t seed, const Building& building, const Truth& truth) {
  experiment::Trial trial{
      .name = building.scenario.name,
      .spec = make_spec(building.scenario, {}),
      .judges = {{.name = "metrics"},
                 {.name = "silence",
                  .settings = {{"stands_s", kStandsLong}, {"limit_s", limit_of(truth)}}},
                 {.name = "place"}},
      .until = "silence",
      .time_ticks = true};
  trial.spec.seed = seed;
  return trial;
}

std::vector<BuildingRun> run_buildings(const Options& options) {
  const std::vector<std::uint64_t> seeds = seeds_of(options);
  std::vector<BuildingRun> runs(options.pool.shard.share(seeds.size()));
  experiment::for_each(seeds.size(), options.pool, [&](std::size_t i, const std::stop_token& stop) {
    BuildingRun& run = runs[i / options.pool.shard.count];
    run.seed = seeds[i];
    run.building = building_of(run.seed, options.controller);
    run.truth = truth_of(run.building);
    run.row = run_trial(trial_of(run.seed, run.building, run.truth), {.stop = stop});
    run.building.scenario.obstacles.clear();
  });
  return runs;
}

BuildingFigures figures_of(const std::vector<const BuildingRun*>& runs) {
  BuildingFigures sum{.runs = runs.size()};
  std::vector<double> ratios;
  for (const BuildingRun* run : runs) {
    const End end = run->end();
    sum.collisions += end == End::Collided ? 1U : 0U;
    if (run->truth.has_way) {
      ++sum.with_way;
      sum.reached += end == End::Reached ? 1U : 0U;
      sum.late += end == End::OutOfTime ? 1U : 0U;
      sum.refused += end == End::Refused || end == End::Blocked || end == End::Silent ? 1U : 0U;
      if (end == End::Reached) ratios.push_back(run->row["time_s"] / *run->truth.time);
    } else if (run->truth.has_none) {
      ++sum.without_way;
      sum.said += end == End::Refused ? 1U : 0U;
    }
  }
  sum.ratio_median = experiment::quantile_of(ratios, 0.5);
  sum.ratio_p95 = experiment::quantile_of(ratios, 0.95);
  return sum;
}

experiment::Table figures_table(const std::vector<BuildingRun>& runs) {
  experiment::Table table{.header = {"",
                                     "buildings",
                                     "with a way",
                                     "reached %",
                                     "refused %",
                                     "late %",
                                     "time over oracle, median",
                                     "p95",
                                     "without a way",
                                     "said so %",
                                     "collisions"}};
  each_group(runs, [&](const std::string& group, const std::vector<const BuildingRun*>& some) {
    const BuildingFigures f = figures_of(some);
    table.rows.push_back({group,
                          fmt::format("{}", f.runs),
                          fmt::format("{}", f.with_way),
                          share(f.reached, f.with_way),
                          share(f.refused, f.with_way),
                          share(f.late, f.with_way),
                          number(f.ratio_median),
                          number(f.ratio_p95),
                          fmt::format("{}", f.without_way),
                          share(f.said, f.without_way),
                          fmt::format("{}", f.collisions)});
  });
  return table;
}

experiment::Table rows_table(const std::vector<BuildingRun>& runs) {
  experiment::Table table;
  for (const BuildingRun& run : runs) {
    add_run(table,
            {"seed", "kind", "goal", "way", "end", "door_m", "oracle_s"},
            {fmt::format("{}", run.seed),
             std::string(name(run.building.kind)),
             std::string(name(run.building.goal_place)),
             std::string(way_word(run.truth)),
             std::string(name(run.end())),
             fmt::format("{:.2f}", run.building.door_width),
             fmt::format("{:.1f}", run.truth.time.value_or(kNone))},
            run.row);
  }
  return table;
}

experiment::Table faults_table(const std::vector<BuildingRun>& runs) {
  experiment::Table table{.header = {"seed",
                                     "kind",
                                     "goal",
                                     "way",
                                     "end",
                                     "reason",
                                     "door m",
                                     "oracle s",
                                     "time s",
                                     "x",
                                     "y"},
                          .words = 6};
  for (const BuildingRun& run : runs) {
    if (as_the_truth_demands(run)) continue;
    table.rows.push_back({fmt::format("{}", run.seed),
                          std::string(name(run.building.kind)),
                          fmt::format("{}{}{}",
                                      name(run.building.goal_place),
                                      run.building.timed_door ? ", door" : "",
                                      run.building.nose_on ? ", nose on" : ""),
                          std::string(way_word(run.truth)),
                          std::string(name(run.end())),
                          run.row.reason,
                          fmt::format("{:.2f}", run.building.door_width),
                          number(run.truth.time.value_or(kNone)),
                          number(run.row["time_s"]),
                          number(run.row["end_x_m"]),
                          number(run.row["end_y_m"])});
  }
  return table;
}

TickTimes tick_times(const std::vector<BuildingRun>& runs) {
  std::vector<double> all;
  for (const BuildingRun& run : runs) {
    all.insert(all.end(), run.row.tick_us.begin(), run.row.tick_us.end());
  }
  return {experiment::quantile_of(all, 0.5), experiment::quantile_of(all, 0.99)};
}

nlohmann::json to_json(const std::vector<BuildingRun>& runs) {
  const TickTimes ticks = tick_times(runs);
  nlohmann::json out = {{"tick_us_p50", ticks.p50}, {"tick_us_p99", ticks.p99}};
  each_group(runs, [&](const std::string& group, const std::vector<const BuildingRun*>& some) {
    const BuildingFigures f = figures_of(some);
    out["groups"][group] = {{"buildings", f.runs},
                            {"with_way", f.with_way},
                            {"reached", f.reached},
                            {"refused", f.refused},
                            {"late", f.late},
                            {"time_ratio_median", f.ratio_median},
                            {"time_ratio_p95", f.ratio_p95},
                            {"without_way", f.without_way},
                            {"said", f.said},
                            {"collisions", f.collisions}};
  });
  out["runs"] = experiment::to_json(rows_table(runs));
  return out;
}

}  // namespace server::buildings
