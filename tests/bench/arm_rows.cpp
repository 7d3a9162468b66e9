// tests/bench/arm_rows.cpp: the arm's inverse, the sweeps of its strip, and whole ticks with it.
#include <algorithm>
#include <vector>

#include "tests/algo/arm/carried_arm.hpp"
#include "tests/bench/rows.hpp"
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "algo/arm/body_strip.hpp"
#include "algo/pipeline/arm_behaviour.hpp"
#include "server/record/headless.hpp"
#include "server/run/scenario_library.hpp"

namespace bench {
namespace {

constexpr double kMicrosecond = 1e-6;
constexpr double kPostReach = 0.70;  // [m] of the arm before the post
constexpr int kSweeps = 50;          // in one tick

/// Poses that the hand reaches.
std::vector<algo::Pose3> hands(std::size_t count) {
  const algo::ArmGeometry arm;
  std::vector<algo::Pose3> poses;
  for (std::size_t k = 0; k < count; ++k) {
    algo::ArmJoints q;
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      q[i] = arm.limits[i] * std::sin(static_cast<double>(k) + 2.3 * static_cast<double>(i));
    }
    poses.push_back(arm_frames(arm, q).hand());
  }
  return poses;
}

void check_inverse(const std::vector<algo::Pose3>& poses) {
  const algo::ArmGeometry arm;
  for (const algo::Pose3& pose : poses) {
    for (std::uint8_t bits = 0; bits < algo::ArmBranch::kCount; ++bits) {
      const auto q = arm_inverse(arm, pose, 0.3, {bits});
      const bool there = q && arm_frames(arm, *q).hand().isApprox(pose, 1e-9);
      require(there, "P24: the inverse misses its pose");
    }
  }
}

/// One run that carries the arm past a post, without a viewer or a record.
/// @return simulated seconds per second of CPU time
double carry_once(double step_rate, double sweeps) {
  server::RunSpec spec = server::make_spec(server::ScenarioLibrary({}, {}).load("arm_post"), {});
  spec.scenario.robot.arm->step_rate = step_rate;
  spec.parameters.set(algo::kArmSweeps, sweeps);
  const auto robot = server::make_robot(spec);
  const double before = process_cpu();
  const server::HeadlessResult run = server::run_headless(spec, *robot, {}, {});
  require(run.run.outcome == algo::Outcome::Reached, "P26: the arm was not carried to its goal");
  return run.run.metrics.time / (process_cpu() - before);
}

/// The whole tick: scanners, physics, strip, guard and gate.
void whole_ticks(Pass& pass) {
  struct Row {
    double step_rate, sweeps, floor, stretch;
  };
  for (const Row& row : {Row{240, 20, 15, 30}, Row{1000, 50, 5, 10}}) {
    std::vector<double> times;
    for (int k = 0; k < pass.count(3, 1); ++k)
      times.push_back(carry_once(row.step_rate, row.sweeps));
    std::ranges::sort(times);
    const double middle = times[times.size() / 2];
    pass.add({.row = "P26",
              .name = fmt::format(
                  "a run with the arm, {} Hz, {} sweeps a tick", row.step_rate, row.sweeps),
              .value = middle,
              .unit = "x real time",
              .better = Better::Higher,
              .floor = row.floor,
              .stretch = row.stretch,
              .noise = (times.back() - times.front()) / middle,
              .note = "Bullet, carried past a post"});
  }
}

}  // namespace

void arms(Pass& pass) {
  whole_ticks(pass);
  const algo::ArmGeometry arm;
  const auto poses = hands(pass.count<std::size_t>(256, 16));
  check_inverse(poses);
  const std::vector<algo::Solid> post{carried_arm::post_before_arm(kPostReach, 0.1)};
  algo::BodyStrip strip{algo::MobileArm{}};
  const auto path = carried_arm::straight_path(kPostReach);
  std::size_t i = 0;
  const auto times = pass.time("P24",
                               {{"inverse",
                                 [&] {
                                   i = (i + 1) % poses.size();
                                   benchmark::DoNotOptimize(arm_inverse(arm, poses[i], 0.3, {}));
                                 }},
                                {"sweeps", [&] {
                                   strip.lay(path);
                                   benchmark::DoNotOptimize(strip.relax(post, kSweeps));
                                 }}});
  pass.add({.row = "P24",
            .name = "inverse of the arm, a call",
            .value = times[0].seconds / kMicrosecond,
            .unit = "us",
            .better = Better::Lower,
            .floor = 1,
            .stretch = 0.25,
            .noise = times[0].spread});
  pass.add({.row = "P24",
            .name = fmt::format("{} sweeps of 21 configurations", kSweeps),
            .value = times[1].seconds / kMicrosecond,
            .unit = "us",
            .better = Better::Lower,
            .floor = 2000,
            .stretch = 1000,
            .noise = times[1].spread,
            .note = "one post; all within one tick"});
}

}  // namespace bench
