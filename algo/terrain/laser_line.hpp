// algo/terrain/laser_line.hpp: points of the ground from the pixels of a laser line.
//
// Source: Park et al. 2005, Eq. 11, 12; equations.md G.
#pragma once

#include <optional>
#include <span>

#include "algo/ground_sense.hpp"
#include "algo/observation.hpp"
#include "algo/types.hpp"

namespace algo {

/// Eq. 11: [x y z]_C = b / (f cot th_lp + v) [f u v], in the camera's frame [m]. Nothing where the
/// ray meets the laser's plane nowhere ahead: a denominator of 1e-9 pixels or less, or a pixel that
/// is not finite.
std::optional<Vec3> triangulated(const LineCamera& camera, double u, double v);

/// Eq. 12: the point `p_C` in R, p_R = R_y(th_rc) p_C + (0, 0, l_rc). The print has no offset along
/// x: ours adds LineCamera::x.
Vec3 to_robot(const LineCamera& camera, const Vec3& p_C);

/// The ground under the two tracks on the laser's line, in R.
struct TrackPoints {
  Vec3 left{0, 0, 0};
  Vec3 right{0, 0, 0};
};

/// The mean of the line's points within 5 cm of the middle of each track, `track` [m] apart.
/// Nothing if fewer than three points lie under either track.
std::optional<TrackPoints> under_tracks(std::span<const Vec3> line_R, double track);

}  // namespace algo
