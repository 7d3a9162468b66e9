// server/lab/barn/barn_run.cpp: runs worlds as trials and summarises their rows.
#include "server/lab/barn/barn_run.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "server/experiment/statistics.hpp"

namespace server::barn {
namespace {

using algo::Outcome;
using experiment::Contact;

Rates rates_of(const std::vector<Run>& runs, const std::string* difficulty) {
  Rates rates;
  for (const Run& run : runs) {
    if (difficulty != nullptr && run.difficulty != *difficulty) continue;
    ++rates.runs;
    rates.success += run.row.outcome == Outcome::Reached ? 1 : 0;
    rates.collisions += run.row.outcome == Outcome::Collided ? 1 : 0;
    rates.timeouts += run.row.outcome == Outcome::OutOfTime ? 1 : 0;
  }
  const auto count = static_cast<double>(std::max<std::size_t>(1, rates.runs));
  for (double* share : {&rates.success, &rates.collisions, &rates.timeouts}) *share /= count;
  return rates;
}

}  // namespace

Contact Run::contact() const {
  return static_cast<Contact>(static_cast<int>(row["contact"]));
}

experiment::Trial trial_of(const World& world, const Conditions& conditions, std::uint64_t seed) {
  experiment::Trial trial{.name = fmt::format("world {}, seed {}", world.id, seed),
                          .spec = make_spec(scenario_of(world, conditions),
                                            {.parameters = conditions.parameters,
                                             .controllers = conditions.controllers}),
                          .judges = {{.name = "metrics"},
                                     {.name = "barn_score",
                                      .settings = {{"goal_radius", world.goal_radius},
                                                   {"optimal_length", world.optimal_length}}},
                                     {.name = "contact"},
                                     {.name = "place"}},
                          .until = "barn_score",
                          .time_ticks = true};
  trial.spec.seed = seed;
  return trial;
}

Result run_worlds(const std::vector<World>& worlds, const Options& options) {
  const auto world_of = [&](std::size_t i) -> const World& { return worlds[i / options.repeats]; };
  const auto seed_of = [&](std::size_t i) { return options.first_seed + i % options.repeats; };
  std::vector<experiment::Row> rows = run_trials(
      worlds.size() * options.repeats,
      [&](std::size_t i) { return trial_of(world_of(i), options.conditions, seed_of(i)); },
      options.pool);
  Result result{.worlds = worlds.size()};
  if (!worlds.empty())
    result.parameters = trial_of(worlds.front(), options.conditions, 1).spec.parameters;
  for (experiment::Row& row : rows) {
    const std::size_t i = options.pool.shard.job(result.runs.size());
    result.runs.push_back({world_of(i).id, seed_of(i), world_of(i).difficulty, std::move(row)});
  }
  return result;
}

std::vector<Bin> by_difficulty(const Result& result) {
  std::vector<Bin> bins;
  for (const Run& run : result.runs) {
    if (run.difficulty.empty()) continue;
    const bool known =
        std::ranges::any_of(bins, [&](const Bin& bin) { return bin.difficulty == run.difficulty; });
    if (!known) bins.push_back({run.difficulty, rates_of(result.runs, &run.difficulty)});
  }
  return bins;
}

Summary summarise(const Result& result) {
  Summary sum{.worlds = result.worlds, .rates = rates_of(result.runs, nullptr)};
  double times = 0;
  std::vector<double> tick_us;
  for (const Run& run : result.runs) {
    sum.avoidable += run.contact() == Contact::Avoidable ? 1U : 0U;
    sum.unavoidable += run.contact() == Contact::Unavoidable ? 1U : 0U;
    sum.jumped += run.contact() == Contact::Jumped ? 1U : 0U;
    sum.score += run.row["barn_score"];
    sum.score_quarter += run.row["barn_score_quarter"];
    if (run.row.outcome == Outcome::Reached) times += run.row["barn_time_s"];
    tick_us.insert(tick_us.end(), run.row.tick_us.begin(), run.row.tick_us.end());
  }
  const auto runs = static_cast<double>(std::max<std::size_t>(1, sum.rates.runs));
  sum.mean_time = sum.rates.success > 0 ? times / (sum.rates.success * runs) : 0;
  sum.score /= runs;
  sum.score_quarter /= runs;
  sum.tick_us_p50 = experiment::quantile_of(tick_us, 0.5);
  sum.tick_us_p99 = experiment::quantile_of(tick_us, 0.99);
  return sum;
}

experiment::Table runs_table(const Result& result) {
  return experiment::tabulated<Run>(
      result.runs,
      3,
      {{"world", [](const Run& run) { return fmt::format("{}", run.world); }},
       {"seed", [](const Run& run) { return fmt::format("{}", run.seed); }},
       {"outcome", [](const Run& run) { return std::string(algo::name(run.row.outcome)); }},
       {"time s", [](const Run& run) { return fmt::format("{:.2f}", run.row["barn_time_s"]); }},
       {"score", [](const Run& run) { return fmt::format("{:.4f}", run.row["barn_score"]); }},
       {"nearest m",
        [](const Run& run) { return fmt::format("{:.3f}", run.row["min_clearance_m"]); }},
       {"path m", [](const Run& run) { return fmt::format("{:.2f}", run.row["path_m"]); }}});
}

experiment::Table rows_table(const Result& result) {
  experiment::Table table;
  for (const Run& run : result.runs) {
    add_run(table,
            {"world", "seed"},
            {fmt::format("{}", run.world), fmt::format("{}", run.seed)},
            run.row);
  }
  return table;
}

}  // namespace server::barn
