// algo/geometry.hpp: where a beam's return lies, and which return is nearest.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "algo/laser_scan.hpp"
#include "algo/types.hpp"

namespace algo {

/// Half of the field whose returns push the strip, either side of straight ahead [rad]: beams
/// 31..329 of a 361-beam scan. The sibling thesis uses 31..330, which is not symmetric.
inline constexpr double kUsedHalfField = 74.5 * std::numbers::pi / 180.0;

/// Return of a beam at `bearing` [rad] in its mount frame and `range` [m], in R:
/// (l_x + r cos(l_th + beta), l_y + r sin(l_th + beta)).
/// Source: Nong 2008 (thesis), the passage before Fig. 17, lost but for its list of ingredients.
Vec2 beam_point_R(const Pose2& mount_R, double bearing, double range);

/// The same in W, for a robot at `pose_W`.
Vec2 beam_point_W(const Pose2& pose_W, const Pose2& mount_R, double bearing, double range);

/// Beams begin <= i < end.
struct BeamSpan {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Beams with from <= bearing < to [rad, mount frame]; a beam within 1e-6 rad of a limit counts as
/// on it. Empty for an empty scan and for an angle_increment that is not above 0.
BeamSpan beams_between(const LaserScan& scan, double from, double to);

/// The used beams right of straight ahead, and from straight ahead to the left: the centre beam
/// belongs to the left, so that the result never depends on rounding.
BeamSpan right_beams(const LaserScan& scan);
BeamSpan left_beams(const LaserScan& scan);

/// The nearest Ok beam of `beams`, by distance from the robot's centre (which is the range only
/// when the scanner is there); the lower index of equals.
struct NearestBeam {
  std::size_t beam = 0;
  double distance = 0;  // [m] |p_R|
};
std::optional<NearestBeam> nearest_beam(const LaserScan& scan, BeamSpan beams);

/// The nearest used beam that is nearer than `avoidance_range` [m] to the robot's centre.
std::optional<NearestBeam> obstacle_check(const LaserScan& scan, double avoidance_range);

/// obstacle_check as the sibling thesis prints it, kept for comparison only: the first of beams
/// 31..330 below the range instead of the nearest, and its angle halved in whole numbers.
struct LiteralCheck {
  std::size_t beam = 0;
  int angle_degrees = 0;  // beam / 2, 0 = right
  double distance = 0;    // [m]
};
/// `ranges` [m] of a scan of 0.5 degree, 360 or 361 beams; shorter ones are read to their end.
std::optional<LiteralCheck> obstacle_check_literal(std::span<const double> ranges,
                                                   double avoidance_range);

}  // namespace algo
