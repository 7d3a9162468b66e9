// algo/full_strip/motion.cpp: roll-outs and checks of the hull.
#include "algo/full_strip/motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace algo {

namespace {

constexpr double kBeside = 0.04;   // [m] outside the hull that must have been seen
constexpr double kStill = 0.01;    // [m/s] of the outline: below it counts as still
constexpr double kRimApart = 0.8;  // of a cell, between two places to check

}  // namespace

HullCheck::HullCheck(const RobotSpec& spec)
    : disc_(spec.radius), radius_(spec.radius), half_width_(spec.radius), axle_(spec.axle) {
  // Places along `length` [m] of outline; a large hull's lie farther apart.
  const auto places = [](double length, std::size_t most) {
    const double count = std::ceil(length / (kRimApart * SeenSpace::kCell));
    return std::min(most, static_cast<std::size_t>(std::max(1.0, count)));
  };
  if (spec.half_length <= 0 || spec.half_width <= 0) {
    const double radius = spec.radius + kBeside;
    const std::size_t count = places(std::numbers::pi * radius, kRims - 1);
    for (std::size_t i = 0; i <= count; ++i) {
      const double turn = std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
      const Vec2 outwards = direction(std::numbers::pi / 2 + turn);
      add_rim(radius * outwards, outwards);
    }
    return;
  }
  const Vec2 corner(spec.half_length + kBeside, spec.half_width + kBeside);
  const std::size_t across = places(2 * corner.y(), kRims / 2 - 1);
  for (std::size_t i = 0; i <= across; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(across);
    add_rim({-corner.x(), (2 * share - 1) * corner.y()}, {-1, 0});
  }
  const std::size_t aside = places(corner.x(), kRims / 4 - 1);
  for (std::size_t i = 0; i <= aside; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(aside);
    for (const double side : {1.0, -1.0}) {
      add_rim({-share * corner.x(), side * corner.y()}, {0, side});
    }
  }
  half_length_ = spec.half_length;
  half_width_ = spec.half_width;
  // More discs follow the long side more closely. One more than twice the ratio is enough.
  const double ratio = spec.half_length / spec.half_width;
  count_ = std::clamp<std::size_t>(static_cast<std::size_t>(std::lround(2 * ratio + 1)), 1, kMost);
  const double piece = spec.half_length / static_cast<double>(count_);  // half of each disc's part
  disc_ = std::hypot(piece, spec.half_width);
  for (std::size_t i = 0; i < count_; ++i) {
    along_[i] = -spec.half_length + piece * (2 * static_cast<double>(i) + 1);
  }
}

bool HullCheck::is_of(const RobotSpec& spec) const {
  const bool disc = spec.half_length <= 0 || spec.half_width <= 0;
  return radius_ == spec.radius && half_length_ == (disc ? 0 : spec.half_length) &&
         half_width_ == (disc ? spec.radius : spec.half_width) && axle_ == spec.axle;
}

void HullCheck::add_rim(const Vec2& point_R, const Vec2& normal_R) {
  rims_.at(rim_count_++) = {point_R, normal_R};
}

bool HullCheck::enters_unseen(const SeenSpace& seen,
                              const Pose2& pose_W,
                              const Twist2& twist) const {
  if (half_length_ <= 0 && twist.v > -kStill) return false;  // a disc that does not back
  const Vec2 ahead = direction(pose_W.heading);
  const Vec2 left(-ahead.y(), ahead.x());
  for (std::size_t i = 0; i < rim_count_; ++i) {
    const Rim& rim = rims_[i];
    const Vec2 velocity_R(twist.v - twist.omega * rim.point_R.y(),
                          twist.omega * (rim.point_R.x() - axle_));
    if (velocity_R.dot(rim.normal_R) < kStill) continue;
    const Vec2 at_W = pose_W.position() + rim.point_R.x() * ahead + rim.point_R.y() * left;
    if (!seen.seen(at_W)) return true;
  }
  return false;
}

void HullCheck::stand_on(SeenSpace& seen, const Pose2& pose_W) const {
  const Vec2 ahead = direction(pose_W.heading);
  for (std::size_t i = 0; i < count_; ++i) {
    seen.mark(pose_W.position() + along_[i] * ahead, half_width_);
  }
}

void HullCheck::take_place(SeenSpace& seen, const Pose2& pose_W) const {
  stand_on(seen, pose_W);
  if (half_length_ <= 0) return;  // a disc needs no room to turn
  seen.mark(pose_W.position(), radius_ + kBeside + SeenSpace::kCell);
}

double HullCheck::clearance(const LocalMap& map, const Pose2& pose_W) const {
  if (!map.keeps_distances()) return exact(map, pose_W);
  const Vec2 ahead = direction(pose_W.heading);
  double least = LocalMap::kReach;
  for (std::size_t i = 0; i < count_; ++i) {
    least = std::min(least, map.distance(pose_W.position() + along_[i] * ahead));
  }
  const double coarse = least - disc_;
  return coarse < kExact ? exact(map, pose_W) : coarse;
}

/// [m] Distance from the hull with its nose along `ahead` to the point at `d` from its centre.
double HullCheck::outside(const Vec2& d, const Vec2& ahead) const {
  if (half_length_ <= 0) return d.norm() - radius_;
  const double dx = std::abs(ahead.dot(d)) - half_length_;
  const double dy = std::abs(cross(ahead, d)) - half_width_;
  if (dx <= 0 && dy <= 0) return std::max(dx, dy);
  const double x = std::max(dx, 0.0);
  const double y = std::max(dy, 0.0);
  return std::sqrt(x * x + y * y);
}

double HullCheck::exact(const LocalMap& map, const Pose2& pose_W) const {
  const Vec2 ahead = direction(pose_W.heading);
  const Vec2 centre = pose_W.position();
  // Beyond it nothing can be nearer than kExact, apart from the offset of a cell's mean from its
  // middle.
  const double reach = radius_ + kExact + LocalMap::kCell;
  double least = kExact + LocalMap::kCell;
  map.each_near(centre, reach, [&](const Vec2& point_W) {
    least = std::min(least, outside(point_W - centre, ahead));
  });
  return least;
}

double HullCheck::distance(const Pose2& pose_W, const Vec2& point_W) const {
  return outside(point_W - pose_W.position(), direction(pose_W.heading));
}

bool HullCheck::covers(const Pose2& pose_W, const Vec2& point_W) const {
  constexpr double kDepth = 0.04;  // [m]
  return distance(pose_W, point_W) < -kDepth;
}

MotionLimits limits_of(const RobotSpec& spec) {
  return {spec.max_v,
          spec.max_omega,
          spec.max_acceleration,
          spec.max_angular_acceleration,
          spec.axle,
          spec.max_jerk,
          spec.max_angular_jerk};
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
  next.pose_W = integrate_arc(state.pose_W, next.twist, dt, limits.axle);
  return next;
}

bool rests_clear(const LocalMap& map,
                 const HullCheck& hull,
                 const MotionState& state,
                 const MotionLimits& limits,
                 double dt,
                 double margin) {
  return rests(state, limits, dt, [&](const MotionState& next) {
    return !hull.enters_unseen(map.seen(), next.pose_W, next.twist) &&
           hull.clearance(map, next.pose_W) >= margin;
  });
}

}  // namespace algo
