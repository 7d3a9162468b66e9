// tests/bench/arm_rows.cpp: the arm's inverse, and the sweeps of its strip.
#include <vector>

#include "tests/algo/arm/carried_arm.hpp"
#include "tests/bench/rows.hpp"
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "algo/arm/body_strip.hpp"

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

}  // namespace

void arms(Pass& pass) {
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
