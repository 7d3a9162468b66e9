// server/lab/mapping/sharpness.hpp: how thin the mapped walls are along a path; tells which of two
// paths is nearer the truth without knowing the truth.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "algo/laser_scan.hpp"
#include "algo/types.hpp"

namespace server::mapping {

/// Counts cells of 4 cm in which a beam of at most 15 m ended, with the scans placed along
/// `path_W`. Gives one count per piece of 10 m of `reference_W`, so that returning to a place is
/// not judged. The more accurate the poses of a piece, the fewer cells its walls take. All three
/// arguments have the same length.
std::vector<std::size_t> wall_cells(std::span<const algo::LaserScan> scans,
                                    std::span<const algo::Pose2> path_W,
                                    std::span<const algo::Pose2> reference_W);

}  // namespace server::mapping
