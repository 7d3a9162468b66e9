// server/emulate/sonar_ring.cpp: pings of a Pioneer's sonars.
#include "server/emulate/sonar_ring.hpp"

#include <algorithm>
#include <array>

#include "algo/units.hpp"

namespace server::emulate {
namespace {

constexpr double kPing = 0.04;     // [s]
constexpr double kHeight = 0.2;    // [m]
constexpr double kNothing = 5.0;   // [m] reported when nothing is heard
constexpr double kNearest = 0.15;  // [m]
constexpr std::size_t kRays = 31;  // of a cone
constexpr double kCone = 30 * algo::units::kRadiansPerDegree;
constexpr std::uint8_t kPerArray = 8;

/// x, y [mm], heading [deg] in R, as the maker's parameter file has them.
constexpr std::array<std::array<int, 3>, 16> kMounts{{
    {69, 136, 90},
    {114, 119, 50},
    {148, 78, 30},
    {166, 27, 10},
    {166, -27, -10},
    {148, -78, -30},
    {114, -119, -50},
    {69, -136, -90},
    {-157, -136, -90},
    {-203, -119, -130},
    {-237, -78, -150},
    {-255, -27, -170},
    {-255, 27, 170},
    {-237, 78, 150},
    {-203, 119, 130},
    {-157, 136, 90},
}};

}  // namespace

SonarRing::SonarRing(const sim::Scenario& scenario) : caster_(kHeight), ranges_(kRays) {
  for (const algo::Obstacle& obstacle : scenario.obstacles) caster_.add(obstacle);
}

double SonarRing::range(std::uint8_t index, const algo::Pose2& robot_W) {
  const auto& [x, y, heading] = kMounts[index];
  const algo::Pose2 mount_R{x / 1000.0, y / 1000.0, heading * algo::units::kRadiansPerDegree};
  const sim::BeamPattern cone{-kCone / 2, kCone / (kRays - 1), kRays};
  caster_.cast(algo::compose(robot_W, mount_R), cone, kNothing, ranges_);
  return std::max(kNearest, *std::ranges::min_element(ranges_));
}

void SonarRing::sense(double now,
                      const algo::Pose2& robot_W,
                      std::vector<drivers::emulators::SonarEcho>& echoes) {
  for (; static_cast<double>(pings_) * kPing <= now; ++pings_) {
    const auto front = static_cast<std::uint8_t>(pings_ % kPerArray);
    for (const std::uint8_t index : {front, static_cast<std::uint8_t>(front + kPerArray)}) {
      echoes.push_back({.index = index, .range = range(index, robot_W)});
    }
  }
}

}  // namespace server::emulate
