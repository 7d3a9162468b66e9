// algo/gate.cpp: the checks, most severe first.
#include "algo/gate.hpp"

#include <algorithm>
#include <cmath>

#include "algo/ground_sense.hpp"

namespace algo {
namespace {

/// True if every pressed bumper lies behind the motion.
bool leaves_bumpers(const Observation& observation, double v) {
  for (const BumperReading& bumper : observation.bumpers) {
    const bool front = bumper.mount_R.x >= 0;
    if (bumper.pressed && !(front ? v < 0 : v > 0)) return false;
  }
  return true;
}

bool finite_joints(const Observation& observation, const Command& command) {
  const auto is_finite = [](double value) { return std::isfinite(value); };
  return std::ranges::all_of(command.joint_rates, is_finite) &&
         (!observation.joints || (std::ranges::all_of(observation.joints->position, is_finite) &&
                                  std::ranges::all_of(observation.joints->rate, is_finite)));
}

}  // namespace

Hold gate(const GateInput& in, const Observation& observation, const Command& command) {
  if (in.stopped) return holds::kStopped;
  if (observation.halt != Halt::None) return holds::kHalted;
  const Odometry& odometry = observation.odometry;
  if (!std::isfinite(observation.stamp) || !finite(odometry.pose) || !finite(odometry.twist) ||
      !finite(command.base) || !finite_joints(observation, command)) {
    return holds::kNotFinite;
  }
  const auto& joints = observation.joints;
  // Written so that a NaN stamp counts as stale.
  if (in.needs_joints && !(joints && observation.stamp - joints->stamp <= in.scan_timeout)) {
    return holds::kNoJoints;
  }
  const auto& tilt = observation.inclinometer;
  if (tilt && is_overturned(tilt->roll, tilt->pitch)) return holds::kOverturned;
  const bool leaves = in.by_hand && leaves_bumpers(observation, command.base.v);
  if (observation.bumper_pressed() && !leaves) return holds::kBumper;
  // Written so that a NaN stamp counts as stale, here and below.
  if (in.needs_tilt && !in.tilt_stamp) return holds::kNoTilt;
  if (in.needs_tilt && !(observation.stamp - *in.tilt_stamp <= in.tilt_timeout)) {
    return holds::kStaleTilt;
  }
  const bool fresh = in.scan_stamp && observation.stamp - *in.scan_stamp <= in.scan_timeout;
  if (!fresh) return in.blinded ? holds::kDazzled : holds::kStaleScan;
  if (in.hidden) return holds::kDazzled;
  const auto& at = observation.map_pose;
  if (!at || at->located() || in.by_hand) return Hold{};
  return {holds::kNotLocated.name, holds::kNotLocated.what, sentence(at->fix)};
}

}  // namespace algo
