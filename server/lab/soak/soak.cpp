// server/lab/soak/soak.cpp: runs random worlds as trials.
#include "server/lab/soak/soak.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "algo/driving.hpp"
#include "server/lab/soak/random_world.hpp"

namespace server::soak {
namespace {

using algo::Outcome;
using experiment::Row;

constexpr double kToSpare = 0.10;  // [m] clearance along a way that surely exists

constexpr std::string_view kSilent = "silent";
constexpr std::string_view kCollision = "collision";
constexpr std::string_view kNotFinite = "not finite";
constexpr std::array<std::string_view, 6> kEndings{
    "reached", "gave a reason", "out of time", kSilent, kCollision, kNotFinite};

bool has_way(std::uint64_t seed, const std::string& controller) {
  const RunSpec spec = make_spec(random_world(seed, controller), {});
  return reachable(spec.scenario,
                   spec.scenario.start.position(),
                   spec.scenario.goal->position_W,
                   make_robot(spec)->spec().radius + kToSpare,
                   spec.parameters[algo::kGoalReach]);
}

}  // namespace

std::string_view ending(const Row& row) {
  if (row["not_finite"] > 0) return kNotFinite;
  if (row["silent"] > 0) return kSilent;
  switch (row.outcome) {
    case Outcome::Reached:
      return "reached";
    case Outcome::Stuck:
      return "gave a reason";
    case Outcome::Collided:
    case Outcome::Overturned:
    case Outcome::Fallen:
      return kCollision;
    default:
      return "out of time";
  }
}

bool is_fault(const Row& row) {
  const std::string_view how = ending(row);
  return how == kSilent || how == kCollision || how == kNotFinite;
}

experiment::Trial trial_of(std::uint64_t seed, const std::string& controller) {
  experiment::Trial trial{.name = fmt::format("world {}", seed),
                          .spec = make_spec(random_world(seed, controller), {}),
                          .judges = {{.name = "metrics"}, {.name = "silence"}, {.name = "place"}},
                          .until = "silence"};
  trial.spec.seed = seed;
  return trial;
}

std::vector<World> run_worlds(const Options& options) {
  std::vector<Row> rows = run_trials(
      options.worlds,
      [&](std::size_t i) { return trial_of(options.first_seed + i, options.controller); },
      options.pool);
  std::vector<World> worlds;
  for (Row& row : rows) {
    const std::size_t i = options.pool.shard.job(worlds.size());
    worlds.push_back({.seed = options.first_seed + i, .row = std::move(row)});
  }
  experiment::for_each(
      worlds.size(), {.threads = options.pool.threads}, [&](std::size_t i, const auto&) {
        worlds[i].has_way = has_way(worlds[i].seed, options.controller);
      });
  return worlds;
}

experiment::Table endings_table(const std::vector<World>& worlds) {
  experiment::Table table{.header = {"", "worlds", "with a way there", "without"}};
  for (const std::string_view how : kEndings) {
    std::array<std::ptrdiff_t, 2> count{};
    for (const bool way : {false, true}) {
      count.at(way ? 1 : 0) = std::ranges::count_if(worlds, [&](const World& world) {
        return ending(world.row) == how && world.has_way == way;
      });
    }
    table.rows.push_back({std::string(how),
                          fmt::format("{}", count[0] + count[1]),
                          fmt::format("{}", count[1]),
                          fmt::format("{}", count[0])});
  }
  return table;
}

experiment::Table rows_table(const std::vector<World>& worlds) {
  experiment::Table table;
  for (const World& world : worlds) {
    add_run(table,
            {"world", "has a way"},
            {fmt::format("{}", world.seed), world.has_way ? "yes" : "no"},
            world.row);
  }
  return table;
}

}  // namespace server::soak
