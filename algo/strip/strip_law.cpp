// algo/strip/strip_law.cpp: the balance of push and pull, and the speed along the strip.
#include "algo/strip/strip_law.hpp"

#include <algorithm>
#include <cmath>

namespace algo {

std::optional<std::string> strip_refusal(const Parameters& parameters) {
  const double step = parameters[kStripStep];
  const double gain = parameters[kRepulsionGain];
  const double safe = parameters[kSafetyDistance];
  if (step < gain * safe) return std::nullopt;
  return "strip_step " + with_unit(step, "m") +
         " must be below k_r x safety_distance = " + with_unit(gain, "") + " x " +
         with_unit(safe, "m") + " = " + with_unit(gain * safe, "m") +
         ", or the robot could be pulled into an obstacle";
}

Twist2 drive_to(const Pose2& pose_W, const Vec2& pass_W, const Parameters& parameters) {
  const Vec2 e = pass_W - pose_W.position();
  const double length = e.norm();
  if (!(length > 0)) return {};
  const double v_max = parameters[kMaxSpeed];
  const double v = std::min(v_max, length * v_max / parameters[kStripStep]);
  return drive_along(pose_W, std::atan2(e.y(), e.x()), v, parameters);
}

}  // namespace algo
