// tests/hardware/experiments.cpp: the thesis experiments over real protocols, and in simulation.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "tests/hardware/bench.hpp"
#include "tests/hardware/stored.hpp"
#include "tests/hardware/trials.hpp"
#include <fmt/format.h>

#include "server/run/scenario_library.hpp"

namespace server::hardware {
namespace {

namespace fs = std::filesystem;
using emulate::BaseKind;

constexpr double kMostLateral = 0.020;  // [m] from the path of the pure simulation

/// [m] From `p` to the nearest point of `path`.
double distance(const algo::Vec2& p, const std::vector<algo::Vec2>& path) {
  double least = (p - path.front()).norm();
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const algo::Vec2 d = path[i + 1] - path[i];
    const double length = d.squaredNorm();
    const double t = length > 0 ? std::clamp((p - path[i]).dot(d) / length, 0.0, 1.0) : 0;
    least = std::min(least, (p - path[i] - t * d).norm());
  }
  return least;
}

/// The path of `scenario` in pure simulation.
std::vector<algo::Vec2> simulated(const std::string& name, std::uint64_t seed, unsigned delay) {
  const ScenarioLibrary library({}, {});
  sim::Scenario scenario = library.load(name);
  scenario.drive.delay_ticks = delay;
  const RunSpec spec = make_spec(scenario, {.seed = seed});
  const std::unique_ptr<algo::Robot> robot = make_robot(spec);
  std::vector<algo::Vec2> path;
  const std::shared_ptr<FramePool> pool = FramePool::make(64);
  algo::Pipeline pipeline(pipeline_config(spec), robot->spec());
  RunLinks links;
  links.pool = pool.get();
  links.listeners.push_back(
      [&](const Frame& frame) { path.push_back(frame.telemetry.ground_truth->pose.position()); });
  const RunPolicy policy{.until_outcome = true, .time_limit = time_limit(spec)};
  run(*robot, pipeline, first_requests(spec), policy, links, {});
  return path;
}

bool experiment(const std::string& scenario, BaseKind base, const fs::path& folder) {
  Bench bench({.scenario = scenario, .base = base, .folder = folder});
  const HeadlessResult result = bench.drive({});
  const Truth truth = read_truth(bench.record());
  const StoredRun stored = read_stored(bench.database());
  // The simulation's commands get the delay of the real line, to a tick.
  const double delay = command_delay(stored, truth, 2 * bench.robot().spec().half_track);
  const auto ticks = static_cast<unsigned>(std::lround(delay / bench.robot().spec().period));
  const auto path = simulated(scenario, 1, ticks);
  double lateral = 0;
  for (const PoseLine& pose : truth.poses) {
    lateral = std::max(lateral, distance(pose.pose_W.position(), path));
  }
  const std::size_t found = found_in_order(stored.scans, truth.scans);
  const bool reached = result.run.outcome == algo::Outcome::Reached;
  const bool held = reached && lateral <= kMostLateral && found == stored.scans.size();
  fmt::print("| {} | {} | {} | {:.1f} | {:.0f} ms, {} ticks | {:.1f} | {} | {} | {} |\n",
             scenario,
             name_of(base),
             algo::name(result.run.outcome),
             result.run.metrics.time,
             1000 * delay,
             ticks,
             1000 * lateral,
             stored.scans.size(),
             stored.scans.size() - found,
             result.run.missed_periods);
  std::fflush(stdout);
  return held;
}

}  // namespace

bool experiments(const fs::path& folder, const std::string& only) {
  fmt::print(
      "| experiment | base | outcome | time [s] | command delay | lateral [mm] | scans stored | "
      "not "
      "as sent | missed periods |\n|---|---|---|---|---|---|---|---|---|\n");
  bool held = true;
  for (const char* scenario : {"exp1", "exp2", "exp3", "exp4"}) {
    for (const BaseKind base : {BaseKind::Roboteq, BaseKind::P2os, BaseKind::Analog}) {
      const std::string name = fmt::format("{}-{}", scenario, name_of(base));
      if (!only.empty() && name != only) continue;
      held = experiment(scenario, base, folder / name) && held;
    }
  }
  return held;
}

}  // namespace server::hardware
