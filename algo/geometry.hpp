// algo/geometry.hpp: the positions of a scan's returns, and the nearest return.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "algo/laser_scan.hpp"
#include "algo/types.hpp"

namespace algo {

/// Half of the field of view whose returns push the strip, to either side of straight ahead [rad]:
/// beams 31..329 of a 361-beam scan. The sibling thesis uses 31..330, which is not symmetric.
inline constexpr double kUsedHalfField = 74.5 * std::numbers::pi / 180.0;

/// The return, in R, of a beam at `bearing` [rad] in its mount frame and `range` [m]:
/// (l_x + r cos(l_th + beta), l_y + r sin(l_th + beta)).
/// Source: Nong 2008 (thesis), the passage before Fig. 17, of which only the list of ingredients
/// survives.
Vec2 beam_point_R(const Pose2& mount_R, double bearing, double range);

/// The same in W, for a robot at `pose_W`.
Vec2 beam_point_W(const Pose2& pose_W, const Pose2& mount_R, double bearing, double range);

/// Beams begin <= i < end.
struct BeamSpan {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Beams with from <= bearing < to [rad, mount frame]. A beam within 1e-6 rad of a limit counts as
/// on it. Empty for an empty scan, and when angle_increment is not above 0.
BeamSpan beams_between(const LaserScan& scan, double from, double to);

/// The used beams right of straight ahead, and those from straight ahead to the left. The centre
/// beam belongs to the left, so that the result never depends on rounding.
BeamSpan right_beams(const LaserScan& scan);
BeamSpan left_beams(const LaserScan& scan);

/// The Ok beam of `beams` whose return is nearest to the robot's centre (not to the scanner). Of
/// equals, the lower index.
struct NearestBeam {
  std::size_t beam = 0;
  double distance = 0;  // [m] |p_R|
};
std::optional<NearestBeam> nearest_beam(const LaserScan& scan, BeamSpan beams);

/// The nearest used beam with a return within `avoidance_range` [m] of the robot's centre.
std::optional<NearestBeam> obstacle_check(const LaserScan& scan, double avoidance_range);

/// obstacle_check() as the sibling thesis prints it, kept for comparison only. It takes the first
/// of beams 31..330 below the range instead of the nearest, and halves its index in whole numbers.
struct LiteralCheck {
  std::size_t beam = 0;
  int angle_degrees = 0;  // beam / 2, 0 = right
  double distance = 0;    // [m]
};
/// `ranges` [m] of a scan with 0.5 degree steps, 360 or 361 beams; a shorter scan is read to its
/// end.
std::optional<LiteralCheck> obstacle_check_literal(std::span<const double> ranges,
                                                   double avoidance_range);

}  // namespace algo
