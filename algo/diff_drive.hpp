// algo/diff_drive.hpp: kinematics of two driven wheels: speeds, dead reckoning, saturation.
//
// Source: Nong 2008 (thesis), section 4.1, which gives the equations only in a figure. Its list
// calls r "the angular velocity at the centre"; r is the wheel radius.
#pragma once

#include <cstdint>

#include "algo/types.hpp"

namespace algo {

struct DriveGeometry {
  double wheel_radius = 0;  // [m] r, > 0
  double half_track = 0;    // [m] l, centre to wheel, > 0: the track is 2 l
  double axle = 0;          // [m] x of the axle in R
};

struct WheelSpeeds {
  double left = 0;   // [rad/s]
  double right = 0;  // [rad/s]
  bool operator==(const WheelSpeeds&) const = default;
};

struct WheelCounts {
  std::int64_t left = 0;
  std::int64_t right = 0;
};

/// Motion of the two sides of a base over the ground: speeds [m/s] or distances [m].
struct SideMotion {
  double left = 0;
  double right = 0;
};

/// left = v - w l, right = v + w l. `half_track`: l [m].
inline SideMotion sides_of(const Twist2& twist, double half_track) {
  const double turn = twist.omega * half_track;
  return {twist.v - turn, twist.v + turn};
}
/// v = (left + right) / 2, w = (right - left) / (2 l). `half_track`: l [m], above 0.
inline Twist2 twist_of(const SideMotion& sides, double half_track) {
  return {(sides.left + sides.right) / 2, (sides.right - sides.left) / (2 * half_track)};
}

/// v = r (q_r + q_l) / 2, w = r (q_r - q_l) / (2 l).
/// Throws std::invalid_argument when r or l is not above 0.
Twist2 forward_kinematics(const DriveGeometry& geometry, const WheelSpeeds& speeds);

/// q_l = (v - w l) / r, q_r = (v + w l) / r. Throws std::invalid_argument as above.
WheelSpeeds inverse_kinematics(const DriveGeometry& geometry, const Twist2& twist);

/// The pose of R after `dt` [s] at constant `twist`; exact along the arc. `axle` [m]: x of the
/// drive axle in R. Its middle moves straight along the heading; R swings about it. Throws
/// std::invalid_argument when dt is below 0 or not finite.
Pose2 integrate_arc(const Pose2& pose, const Twist2& twist, double dt, double axle = 0);

/// The pose after the wheels have moved by `counts` of `counts_per_turn`. Each wheel rolls
/// s = 2 pi r n / counts_per_turn; the motion is taken as one arc.
/// Throws std::invalid_argument when r, l or counts_per_turn is not above 0.
Pose2 integrate_counts(const DriveGeometry& geometry,
                       double counts_per_turn,
                       const Pose2& pose,
                       const WheelCounts& counts);

/// now - before, for a counter of `bits` bits that wraps around: the smaller signed difference.
/// Throws std::invalid_argument when bits is not 2..32.
std::int64_t count_difference(std::uint32_t now, std::uint32_t before, unsigned bits = 32);

}  // namespace algo
