// algo/types.hpp: poses, twists and commands; metres, radians, seconds, ccw positive.
//
// Frames: world W, robot R (x ahead, y left), sensor mount in R. A trailing _W or _R names the
// frame a quantity is expressed in.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include <Eigen/Core>

namespace algo {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;

/// `angle` [rad] wrapped to (-pi, pi].
inline double wrap_angle(double angle) {
  // The angle is nearly always within the range already, and the division is the costly part.
  if (std::abs(angle) < std::numbers::pi) return angle;
  const double wrapped = std::remainder(angle, 2.0 * std::numbers::pi);
  return wrapped <= -std::numbers::pi ? std::numbers::pi : wrapped;
}

/// `now` moved towards `wanted` by `most` at most.
inline double towards(double now, double wanted, double most) {
  return now + std::clamp(wanted - now, -most, most);
}

/// floor(x), for numbers that an int holds. Without SSE4.1, which not every processor has, the
/// library's takes five times as long.
inline int whole_below(double x) {
  const int cut = static_cast<int>(x);
  return x < cut ? cut - 1 : cut;
}

/// Position and heading of a frame in its parent: robot R in W, or a sensor in R.
struct Pose2 {
  double x = 0;        // [m]
  double y = 0;        // [m]
  double heading = 0;  // [rad] ccw from the parent's x axis, in (-pi, pi]

  Vec2 position() const { return {x, y}; }
  bool operator==(const Pose2&) const = default;
};

inline bool finite(const Pose2& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.heading);
}

/// Above 0 where `b` points to the left of `a`.
inline double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Unit vector of bearing `angle` [rad].
inline Vec2 direction(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

/// [rad] The bearing of (x, y) within kRoughBearing, for a quarter of the time of std::atan2. Zero
/// for (0, 0). Source: Abramowitz and Stegun 1964, 4.4.49.
inline double rough_bearing(double y, double x) {
  const double along = std::abs(x);
  const double aside = std::abs(y);
  const double most = std::max(along, aside);
  const double t = most > 0 ? std::min(along, aside) / most : 0;
  const double s = t * t;
  double angle =
      t * (0.9998660 + s * (-0.3302995 + s * (0.1801410 + s * (-0.0851330 + s * 0.0208351))));
  if (aside > along) angle = std::numbers::pi / 2 - angle;
  if (x < 0) angle = std::numbers::pi - angle;
  return y < 0 ? -angle : angle;
}
inline constexpr double kRoughBearing = 2e-5;  // [rad]

/// Point `p` of the child frame expressed in the parent of `pose`.
inline Vec2 to_parent(const Pose2& pose, const Vec2& p) {
  const double c = std::cos(pose.heading);
  const double s = std::sin(pose.heading);
  return {pose.x + c * p.x() - s * p.y(), pose.y + s * p.x() + c * p.y()};
}

/// Point `p` of the parent of `pose` expressed in the child frame.
inline Vec2 to_child(const Pose2& pose, const Vec2& p) {
  const Vec2 ahead = direction(pose.heading);
  const Vec2 way = p - pose.position();
  return {ahead.dot(way), cross(ahead, way)};
}

/// `inner` (a pose in the child frame of `outer`) expressed in the parent of `outer`.
inline Pose2 compose(const Pose2& outer, const Pose2& inner) {
  const Vec2 p = to_parent(outer, inner.position());
  return {p.x(), p.y(), wrap_angle(outer.heading + inner.heading)};
}

/// The pose `to_W` in the frame of `from_W`: compose(from_W, pose_step(from_W, to_W)) is `to_W`.
inline Pose2 pose_step(const Pose2& from_W, const Pose2& to_W) {
  const Vec2 p = to_child(from_W, to_W.position());
  return {p.x(), p.y(), wrap_angle(to_W.heading - from_W.heading)};
}

/// The pose at fraction `t` of the way from `a` to `b`, by the shorter turn.
inline Pose2 interpolated(const Pose2& a, const Pose2& b, double t) {
  return {a.x + t * (b.x - a.x),
          a.y + t * (b.y - a.y),
          wrap_angle(a.heading + t * wrap_angle(b.heading - a.heading))};
}

struct Twist2 {
  double v = 0;      // [m/s] along R's x axis
  double omega = 0;  // [rad/s]
  bool operator==(const Twist2&) const = default;
};

inline bool finite(const Twist2& twist) {
  return std::isfinite(twist.v) && std::isfinite(twist.omega);
}

constexpr std::size_t kMostJoints = 8;

/// The command for one period.
struct Command {
  Twist2 base{};
  std::uint8_t joints = 0;                        // number of the arm's joints
  std::array<double, kMostJoints> joint_rates{};  // [rad/s]; 0 beyond the first `joints`
  bool operator==(const Command&) const = default;
};

}  // namespace algo
