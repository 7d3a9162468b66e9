// algo/gate.cpp: the checks, the worst first.
#include "algo/gate.hpp"

#include <cmath>

namespace algo {
namespace {

bool finite(const Odometry& odometry) {
  return std::isfinite(odometry.pose.x) && std::isfinite(odometry.pose.y) &&
         std::isfinite(odometry.pose.heading) && std::isfinite(odometry.twist.v) &&
         std::isfinite(odometry.twist.omega);
}

bool finite(const Twist2& twist) {
  return std::isfinite(twist.v) && std::isfinite(twist.omega);
}

/// Whether every bumper that is pressed lies behind the motion.
bool leaves_bumpers(const Observation& observation, double v) {
  for (const BumperReading& bumper : observation.bumpers) {
    const bool front = bumper.mount_R.x >= 0;
    if (bumper.pressed && !(front ? v < 0 : v > 0)) return false;
  }
  return true;
}

}  // namespace

Hold gate(const GateInput& in, const Observation& observation, const Command& command) {
  if (in.stopped) return holds::kStopped;
  if (observation.halt != Halt::None) return holds::kHalted;
  if (!std::isfinite(observation.stamp) || !finite(observation.odometry) || !finite(command.base)) {
    return holds::kNotFinite;
  }
  const bool leaves = in.by_hand && leaves_bumpers(observation, command.base.v);
  if (observation.bumper_pressed() && !leaves) return holds::kBumper;
  // Written so that a stamp that is not a number counts as stale.
  const bool fresh = in.scan_stamp && observation.stamp - *in.scan_stamp <= in.scan_timeout;
  if (!fresh) return in.blinded ? holds::kDazzled : holds::kStaleScan;
  return in.hidden ? holds::kDazzled : Hold{};
}

}  // namespace algo
