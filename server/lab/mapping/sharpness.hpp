// server/lab/mapping/sharpness.hpp: how thin a path makes the walls it maps; says which of two
// paths is nearer the truth without knowing it.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "algo/laser_scan.hpp"
#include "algo/types.hpp"

namespace server::mapping {

/// Cells of 4 cm in which a beam of at most 15 m ended, when the scans are laid along `path_W`;
/// one count for each piece of 10 m of `reference_W`, so that no coming back is judged. The
/// truer the poses of a piece, the fewer cells its walls take. All as long as each other.
std::vector<std::size_t> wall_cells(std::span<const algo::LaserScan> scans,
                                    std::span<const algo::Pose2> path_W,
                                    std::span<const algo::Pose2> reference_W);

}  // namespace server::mapping
