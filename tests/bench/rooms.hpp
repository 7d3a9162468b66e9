// tests/bench/rooms.hpp: poses, casters and noise in the reference world W(K), for several rows.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "tests/sim/reference_world.hpp"

#include "algo/obstacle.hpp"
#include "algo/types.hpp"
#include "sim/range_caster.hpp"
#include "sim/scenario.hpp"

namespace bench {

constexpr double kPlane = 0.35;  // [m] height of the scan plane
constexpr double kTick = 0.026;  // [s]
constexpr std::size_t kBeams = 361;
constexpr double kNearRange = 8.191;  // [m] millimetre mode
constexpr double kFarRange = 30.0;    // [m]

inline sim::BeamPattern half_turn() {
  return {-std::numbers::pi / 2, std::numbers::pi / 360, kBeams};
}
inline double bearing(std::size_t beam) {
  return -std::numbers::pi / 2 + static_cast<double>(beam) * std::numbers::pi / 360;
}

/// `count` poses anywhere in W(`obstacles`) where the robot would fit.
inline std::vector<algo::Pose2> poses_in(const std::vector<algo::Obstacle>& world,
                                         std::uint32_t obstacles,
                                         std::size_t count) {
  constexpr double kHull = 0.36;  // [m]
  std::mt19937_64 random(obstacles + 7);
  const double half = 5 * std::sqrt(obstacles / 20.0);
  std::vector<algo::Pose2> poses;
  while (poses.size() < count) {
    const algo::Pose2 pose{reference::uniform(random, -half, half),
                           reference::uniform(random, -half, half),
                           reference::uniform(random, -std::numbers::pi, std::numbers::pi)};
    bool fits = true;
    for (const algo::Obstacle& obstacle : world) {
      fits = fits && algo::signed_distance(obstacle, pose.position()) > kHull;
    }
    if (fits) poses.push_back(pose);
  }
  return poses;
}

inline sim::RangeCaster caster_of(const std::vector<algo::Obstacle>& world) {
  sim::RangeCaster caster(kPlane);
  for (const algo::Obstacle& obstacle : world) caster.add(obstacle);
  return caster;
}

/// The LMS200 as it is sold: rolling, noisy, with mixed pixels and lost beams.
inline sim::LaserConfig full_laser() {
  sim::LaserConfig laser = sim::LaserConfig::with_resolution(0.5);
  laser.height = kPlane;
  return laser;
}

}  // namespace bench
