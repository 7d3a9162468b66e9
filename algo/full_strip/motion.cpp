// algo/full_strip/motion.cpp: roll-outs.
#include "algo/full_strip/motion.hpp"

#include <algorithm>
#include <cmath>

namespace algo {

HullCheck::HullCheck(const RobotSpec& spec)
    : disc_(spec.radius), radius_(spec.radius), half_width_(spec.radius) {
  if (spec.half_length <= 0 || spec.half_width <= 0) return;
  half_length_ = spec.half_length;
  half_width_ = spec.half_width;
  // The more discs the closer they follow the long side; one more than twice its length is enough.
  const double ratio = spec.half_length / spec.half_width;
  count_ = std::clamp<std::size_t>(static_cast<std::size_t>(std::lround(2 * ratio + 1)), 1, kMost);
  const double piece = spec.half_length / static_cast<double>(count_);  // half of what one covers
  disc_ = std::hypot(piece, spec.half_width);
  for (std::size_t i = 0; i < count_; ++i) {
    along_[i] = -spec.half_length + piece * (2 * static_cast<double>(i) + 1);
  }
}

double HullCheck::clearance(const LocalMap& map, const Pose2& pose_W) const {
  const Vec2 ahead = direction(pose_W.heading);
  double least = LocalMap::kReach;
  for (std::size_t i = 0; i < count_; ++i) {
    least = std::min(least, map.distance(pose_W.position() + along_[i] * ahead));
  }
  const double coarse = least - disc_;
  return coarse < kExact ? exact(map, pose_W) : coarse;
}

/// [m] From the hull with its nose along `ahead` to the point at `d` from its centre.
double HullCheck::outside(const Vec2& d, const Vec2& ahead) const {
  if (half_length_ <= 0) return d.norm() - radius_;
  const double dx = std::abs(ahead.dot(d)) - half_length_;
  const double dy = std::abs(ahead.x() * d.y() - ahead.y() * d.x()) - half_width_;
  if (dx <= 0 && dy <= 0) return std::max(dx, dy);
  const double x = std::max(dx, 0.0);
  const double y = std::max(dy, 0.0);
  return std::sqrt(x * x + y * y);
}

double HullCheck::exact(const LocalMap& map, const Pose2& pose_W) const {
  const Vec2 ahead = direction(pose_W.heading);
  const Vec2 centre = pose_W.position();
  // Beyond it nothing can be nearer than kExact, but for what its cell's middle and mean differ by.
  const double reach = radius_ + kExact + LocalMap::kCell;
  double least = kExact + LocalMap::kCell;
  map.each_near(centre, reach, [&](const Vec2& point_W) {
    least = std::min(least, outside(point_W - centre, ahead));
  });
  return least;
}

bool HullCheck::covers(const Pose2& pose_W, const Vec2& point_W) const {
  constexpr double kDepth = 0.04;  // [m]
  return outside(point_W - pose_W.position(), direction(pose_W.heading)) < -kDepth;
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
                 const HullCheck& hull,
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
