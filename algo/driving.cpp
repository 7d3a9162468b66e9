// algo/driving.cpp: the driving law and the check of its inputs.
#include "algo/driving.hpp"

#include <algorithm>
#include <cmath>

namespace algo {
namespace {

bool finite(const std::optional<Nearest>& nearest) {
  return !nearest || (nearest->point_W.allFinite() && std::isfinite(nearest->distance));
}

bool finite(const LaserScan& scan) {
  if (!finite(scan.mount_R) || !std::isfinite(scan.angle_min) ||
      !std::isfinite(scan.angle_increment) || !std::isfinite(scan.range_max)) {
    return false;
  }
  // Usually all ranges are finite, unused ones too.
  if (all_finite(scan.ranges)) return true;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (scan.status[i] == Beam::Ok && !std::isfinite(scan.ranges[i])) return false;
  }
  return true;
}

}  // namespace

bool all_finite(const ControlInput& in, const Parameters& parameters) {
  if (!parameters.all_finite()) return false;
  if (in.goal && !in.goal->position_W.allFinite()) return false;
  if (in.goal && in.goal->heading && !std::isfinite(*in.goal->heading)) return false;
  const Odometry& odometry = in.odometry;
  return std::isfinite(in.stamp) && std::isfinite(in.dt) && std::isfinite(in.spec->radius) &&
         std::isfinite(odometry.stamp) && finite(odometry.pose) && finite(odometry.twist) &&
         finite(in.scene->left) && finite(in.scene->right) && finite(in.scene->scan);
}

Twist2 drive_along(const Pose2& pose_W,
                   double bearing_W,
                   double speed,
                   const Parameters& parameters) {
  const double w_max = parameters[kMaxTurnRate];
  const double turn = wrap_angle(bearing_W - pose_W.heading);
  const double w = parameters[kHeadingGain] * turn;
  return {speed * std::max(0.0, std::cos(turn)), std::clamp(w, -w_max, w_max)};
}

Twist2 turn_to(const Pose2& pose_W, const SetGoal& goal, const Parameters& parameters) {
  if (!goal.heading) return {};
  const double error = wrap_angle(*goal.heading - pose_W.heading);
  if (std::abs(error) < kHeadingReach) return {};
  const double limit = parameters[kMaxTurnRate];
  return {0, std::clamp(parameters[kHeadingGain] * error, -limit, limit)};
}

}  // namespace algo
