// algo/diff_drive.cpp: differential drive, equations.md I.
#include "algo/diff_drive.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace algo {
namespace {

constexpr double kStraight = 1e-9;  // [rad] a smaller turn counts as a straight line

void require_positive(const char* what, double value) {
  if (std::isfinite(value) && value > 0) return;
  throw std::invalid_argument(std::string(what) + " must be above 0, not " + std::to_string(value));
}

void require_sound(const DriveGeometry& geometry) {
  require_positive("wheel_radius", geometry.wheel_radius);
  require_positive("half_track", geometry.half_track);
}

}  // namespace

Twist2 forward_kinematics(const DriveGeometry& geometry, const WheelSpeeds& speeds) {
  require_sound(geometry);
  return twist_of({geometry.wheel_radius * speeds.left, geometry.wheel_radius * speeds.right},
                  geometry.half_track);
}

WheelSpeeds inverse_kinematics(const DriveGeometry& geometry, const Twist2& twist) {
  require_sound(geometry);
  const SideMotion sides = sides_of(twist, geometry.half_track);
  return {sides.left / geometry.wheel_radius, sides.right / geometry.wheel_radius};
}

Pose2 integrate_arc(const Pose2& pose, const Twist2& twist, double dt, double axle) {
  if (!(std::isfinite(dt) && dt >= 0)) {
    throw std::invalid_argument("dt must be 0 or above, not " + std::to_string(dt));
  }
  if (axle != 0) {
    const Pose2 middle_W = compose(pose, {axle, 0, 0});
    return compose(integrate_arc(middle_W, twist, dt), {-axle, 0, 0});
  }
  const double turn = twist.omega * dt;
  Pose2 moved = pose;
  if (std::abs(turn) < kStraight) {
    moved.x += twist.v * dt * std::cos(pose.heading);
    moved.y += twist.v * dt * std::sin(pose.heading);
  } else {
    // v/w (sin(th + a) - sin th), written with the half angle: the difference of two nearly equal
    // sines would lose half of the digits at small turns.
    const double chord = 2 * twist.v / twist.omega * std::sin(turn / 2);
    moved.x += chord * std::cos(pose.heading + turn / 2);
    moved.y += chord * std::sin(pose.heading + turn / 2);
  }
  moved.heading = wrap_angle(pose.heading + turn);
  return moved;
}

Pose2 integrate_counts(const DriveGeometry& geometry,
                       double counts_per_turn,
                       const Pose2& pose,
                       const WheelCounts& counts) {
  require_sound(geometry);
  require_positive("counts_per_turn", counts_per_turn);
  const double per_count = 2 * std::numbers::pi * geometry.wheel_radius / counts_per_turn;
  const SideMotion rolled{per_count * static_cast<double>(counts.left),
                          per_count * static_cast<double>(counts.right)};
  return integrate_arc(pose, twist_of(rolled, geometry.half_track), 1.0, geometry.axle);
}

std::int64_t count_difference(std::uint32_t now, std::uint32_t before, unsigned bits) {
  if (bits < 2 || bits > 32) {
    throw std::invalid_argument("a counter has 2 to 32 bits, not " + std::to_string(bits));
  }
  const std::int64_t span = std::int64_t{1} << bits;
  const std::int64_t raw = (std::int64_t{now} - std::int64_t{before}) & (span - 1);
  return raw >= span / 2 ? raw - span : raw;
}

}  // namespace algo
