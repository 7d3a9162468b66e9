// server/emulate/sonar_ring.cpp: pings of a Pioneer's sonars.
#include "server/emulate/sonar_ring.hpp"

#include <algorithm>

#include "algo/units.hpp"
#include "drivers/robot_file.hpp"
#include "sim/obstacle_set.hpp"

namespace server::emulate {
namespace {

constexpr double kPing = 0.04;     // [s]
constexpr double kHeight = 0.2;    // [m]
constexpr double kNothing = 5.0;   // [m] reported without an echo
constexpr double kNearest = 0.15;  // [m]
constexpr std::size_t kRays = 31;  // per cone
constexpr double kCone = 30 * algo::units::kRadiansPerDegree;
constexpr std::uint8_t kPerArray = 8;

}  // namespace

SonarRing::SonarRing(const sim::Scenario& scenario)
    : mounts_R_(drivers::pioneer_sonars()), caster_(kHeight), ranges_(kRays) {
  for (const algo::Obstacle& obstacle : scenario.obstacles) {
    caster_.add(obstacle);
    if (obstacle.path) moving_.push_back(obstacle);
  }
}

double SonarRing::range(std::uint8_t index, const algo::Pose2& robot_W) {
  const sim::BeamPattern cone{-kCone / 2, kCone / (kRays - 1), kRays};
  caster_.cast(algo::compose(robot_W, mounts_R_[index]), cone, kNothing, ranges_);
  return std::max(kNearest, *std::ranges::min_element(ranges_));
}

void SonarRing::sense(double now,
                      const algo::Pose2& robot_W,
                      std::vector<drivers::emulators::SonarEcho>& echoes) {
  for (const algo::Obstacle& obstacle : moving_) {
    caster_.move(obstacle.id, sim::pose_at(obstacle, now));
  }
  for (; static_cast<double>(pings_) * kPing <= now; ++pings_) {
    const auto front = static_cast<std::uint8_t>(pings_ % kPerArray);
    for (const std::uint8_t index : {front, static_cast<std::uint8_t>(front + kPerArray)}) {
      echoes.push_back({.index = index, .range = range(index, robot_W)});
    }
  }
}

}  // namespace server::emulate
