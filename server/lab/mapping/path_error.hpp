// server/lab/mapping/path_error.hpp: how far one path of a robot is off another.
#pragma once

#include <cstddef>
#include <span>

#include "algo/types.hpp"

namespace server::mapping {

/// A path against the one held for true, both from the same first pose.
struct PathError {
  double end = 0;       // [m] between the last positions
  double rms = 0;       // [m] between the positions along the way, root mean square
  double rms_10m = 0;   // [m] relative error over pieces of 10 m, root mean square
  double turn_10m = 0;  // [rad] the same of the heading
  std::size_t pieces = 0;
};

/// Relative error of a piece from pose i to the first pose j at least 10 m of the true way on: of
/// the step from i to j, as the robot at i sees it, the estimate's less the truth's (Kuemmerle et
/// al. 2009; one for each i that has such a j). Divided by the way in tens of metres, `rms` is an
/// error per 10 m as well, which forgives what the truth's own headings are unsteady by.
PathError path_error(std::span<const algo::Pose2> true_W, std::span<const algo::Pose2> estimate_W);

/// [m] Along the positions.
double path_length(std::span<const algo::Pose2> path_W);

}  // namespace server::mapping
