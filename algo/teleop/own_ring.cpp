// algo/teleop/own_ring.cpp: the newest echoes, sorted into the ring's cones.
#include "algo/teleop/own_ring.hpp"

#include <algorithm>
#include <limits>

#include "algo/perceive.hpp"

namespace algo {
namespace {

constexpr auto kAxes = ring_bearings();
constexpr double kClockRounding = 1e-9;  // [s] of sums of periods

}  // namespace

void OwnRing::take(const Observation& observation) {
  hear(observation.odometry.pose, observation.sonar, echoes_);
}

Ring OwnRing::read(const Pose2& pose_W, double now, const Parameters& parameters) const {
  Ring ring;
  RingReadings& out = ring.distances;
  out.fill(parameters[kRingReach]);
  for (const Echo& echo : echoes_) {
    const bool old = now - echo.stamp > kOldestEcho + kClockRounding;
    const double d = (echo.point_W - pose_W.position()).norm();
    for (std::size_t n = 0; n < kRingSonars; ++n) {
      if (!in_cone(kAxes[n], echo.mount_R.heading)) continue;
      if (old) out[n] = std::numeric_limits<double>::quiet_NaN();
      if (!old && echo.hit) out[n] = std::min(out[n], d);  // NaN stays
    }
  }
  return ring;
}

}  // namespace algo
