// server/lab/mapping/path_error.hpp: the error of one path against another.
#pragma once

#include <cstddef>
#include <span>

#include "algo/types.hpp"

namespace server::mapping {

/// The error of a path against the true one; both have the same first pose.
struct PathError {
  double end = 0;       // [m] between the last positions
  double rms = 0;       // [m] between positions along the way, root mean square
  double rms_10m = 0;   // [m] relative error over pieces of 10 m, root mean square
  double turn_10m = 0;  // [rad] likewise for the heading
  std::size_t pieces = 0;
};

/// A piece goes from pose i to the first pose j at least 10 m farther along the true path; each i
/// with such a j gives one piece. Its relative error is the step from i to j, seen from pose i: the
/// estimate's minus the truth's (Kuemmerle et al. 2009). `rms` divided by the path length in tens
/// of metres is also an error per 10 m, and it does not suffer from unsteady headings of the truth.
PathError path_error(std::span<const algo::Pose2> true_W, std::span<const algo::Pose2> estimate_W);

/// [m] Length along the positions.
double path_length(std::span<const algo::Pose2> path_W);

}  // namespace server::mapping
