// algo/strip/side_choice.cpp: blocked test, cluster, latch and push, equations.md E.4.
#include "algo/strip/side_choice.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace algo {
namespace {

constexpr double kForgetAfter = 2.0;   // [s] without a blocked lane
constexpr double kLaneMargin = 0.1;    // [m] beyond the hull: 450 mm for the 350 mm robot
constexpr double kChooseMargin = 0.1;  // [m] beyond the reach: a side is chosen this early
constexpr double kClusterDepth = 0.8;  // [m] largest difference of the ranges in one cluster
constexpr double kCosFull = std::numbers::sqrt2 * (std::numbers::sqrt3 + 1) / 4;  // cos 15 degrees
constexpr double kCosNone = std::numbers::sqrt2 / 2;                              // cos 45 degrees

Vec2 left_of(const Vec2& u) {
  return {-u.y(), u.x()};
}

}  // namespace

Side choose_side(const LaserScan& scan, std::size_t beam, double goal_bearing_R) {
  const double limit = scan.ranges[beam] + kClusterDepth;
  const auto ends = [&](std::size_t i) {
    return scan.status[i] == Beam::Free ||
           (scan.status[i] == Beam::Ok && !(scan.ranges[i] < limit));
  };
  std::size_t left = beam;
  for (std::size_t i = beam + 1; i < scan.size() && !ends(i); ++i) {
    if (scan.status[i] == Beam::Ok) left = i;
  }
  std::size_t right = beam;
  for (std::size_t i = beam; i-- > 0 && !ends(i);) {
    if (scan.status[i] == Beam::Ok) right = i;
  }
  const double bearing = wrap_angle(goal_bearing_R - scan.mount_R.heading);
  const double goal = (bearing - scan.angle_min) / scan.angle_increment;
  const double beyond_left = static_cast<double>(left) - goal;
  const double beyond_right = goal - static_cast<double>(right);
  return beyond_left <= beyond_right ? Side::Left : Side::Right;
}

double side_share(const Vec2& force_W, const Vec2& to_goal_W) {
  const double size = force_W.norm();
  if (!(size > 0)) return 0;
  const double c = -force_W.dot(to_goal_W) / size;
  return std::clamp((c - kCosNone) / (kCosFull - kCosNone), 0.0, 1.0);
}

/// The nearest beam with a return q inside the lane: 0 < q.u < min(D, reach + radius) and
/// |q.n| < radius + 0.1 m.
std::optional<std::size_t> SideChoice::blocking_beam(const SideInput& in) {
  const LaserScan& scan = *in.scan;
  if (!(scan.angle_increment > 0)) return std::nullopt;  // the beams have no order
  const std::vector<Vec2>& directions_R = directions_R_.of(scan, scan.mount_R.heading);
  const Vec2 to_goal_W = in.goal_W - in.pose_W.position();
  const double lane_length = std::min(to_goal_W.norm(), in.reach + in.robot_radius);
  const double lane_half_width = in.robot_radius + kLaneMargin;
  const double bearing_W = std::atan2(to_goal_W.y(), to_goal_W.x());
  const Vec2 u = direction(bearing_W - in.pose_W.heading);
  const Vec2 n = left_of(u);
  const Vec2 l = scan.mount_R.position();
  // No return with a longer range can be in the lane.
  double nearest = std::hypot(lane_length, lane_half_width) + l.norm();
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (!(scan.ranges[i] < nearest) || scan.status[i] != Beam::Ok) continue;
    const Vec2 q = l + scan.ranges[i] * directions_R[i];
    const double along = q.dot(u);
    if (along > 0 && along < lane_length && std::abs(q.dot(n)) < lane_half_width) {
      nearest = scan.ranges[i];
      found = i;
    }
  }
  return found;
}

SidePush SideChoice::update(const SideInput& in, const Vec2& force_W) {
  SidePush push;
  const Vec2 way = in.goal_W - in.pose_W.position();
  const double distance = way.norm();
  if (!(distance > 0)) return push;
  push.blocked_beam = blocking_beam(in);
  if (!push.blocked_beam) {
    const bool forget = !state_.last_blocked || in.stamp - *state_.last_blocked > kForgetAfter;
    if (forget) state_ = {};
    return push;
  }
  state_.last_blocked = in.stamp;
  const std::size_t beam = *push.blocked_beam;
  if (state_.side == Side::None && in.scan->ranges[beam] < in.reach + kChooseMargin) {
    const double bearing_R = std::atan2(way.y(), way.x()) - in.pose_W.heading;
    state_.side = choose_side(*in.scan, beam, bearing_R);
    state_.since = in.stamp;
  }
  if (state_.side == Side::None) return push;
  const Vec2 u = way / distance;
  push.alpha = side_share(force_W, u);
  push.force_W = push.alpha * force_W.norm() * static_cast<double>(state_.side) * left_of(u);
  return push;
}

}  // namespace algo
