// algo/full_strip/motion.cpp: roll-outs.
#include "algo/full_strip/motion.hpp"

#include <algorithm>
#include <cmath>

namespace algo {

HullDiscs::HullDiscs(const RobotSpec& spec) {
  if (spec.half_length <= 0 || spec.half_width <= 0) {
    radius_ = spec.radius;
    half_width_ = spec.radius;
    return;
  }
  // The more discs the closer they follow the long side; one more than twice its length is enough.
  const double ratio = spec.half_length / spec.half_width;
  count_ = std::clamp<std::size_t>(static_cast<std::size_t>(std::lround(2 * ratio + 1)), 1, kMost);
  const double piece = spec.half_length / static_cast<double>(count_);  // half of what one covers
  radius_ = std::hypot(piece, spec.half_width);
  half_width_ = spec.half_width;
  for (std::size_t i = 0; i < count_; ++i) {
    along_[i] = -spec.half_length + piece * (2 * static_cast<double>(i) + 1);
  }
}

double HullDiscs::clearance(const LocalMap& map, const Pose2& pose_W) const {
  const Vec2 ahead = direction(pose_W.heading);
  double least = LocalMap::kReach;
  for (std::size_t i = 0; i < count_; ++i) {
    least = std::min(least, map.distance(pose_W.position() + along_[i] * ahead));
  }
  return least - radius_;
}

MotionState advanced(const MotionState& state,
                     const Twist2& command,
                     const MotionLimits& limits,
                     double dt) {
  const double dv = limits.acceleration * dt;
  const double dw = limits.angular_acceleration * dt;
  MotionState next;
  next.twist = {state.twist.v + std::clamp(command.v - state.twist.v, -dv, dv),
                state.twist.omega + std::clamp(command.omega - state.twist.omega, -dw, dw)};
  next.pose_W = integrate_arc(state.pose_W, next.twist, dt);
  return next;
}

bool rests_clear(const LocalMap& map,
                 const HullDiscs& hull,
                 MotionState state,
                 const MotionLimits& limits,
                 double dt,
                 double margin) {
  constexpr int kMost = 400;  // a base that cannot brake is not proven safe
  for (int k = 0; k < kMost; ++k) {
    if (state.twist == Twist2{}) return true;
    state = advanced(state, {}, limits, dt);
    if (hull.clearance(map, state.pose_W) < margin) return false;
  }
  return false;
}

}  // namespace algo
