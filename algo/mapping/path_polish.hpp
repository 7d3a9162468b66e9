// algo/mapping/path_polish.hpp: lays each scan of a fitted path onto the walls seen before.
#pragma once

#include <span>
#include <vector>

#include "algo/laser_scan.hpp"
#include "algo/mapping/mapper_settings.hpp"
#include "algo/types.hpp"

namespace algo {

/// Matches each scan to the map of all scans before it, from its pose in `path_W` on. The fit of
/// the graph spreads errors evenly over the path; this takes out the last centimetres, where walls
/// tell. Nothing drifts, because corrections fade: each match starts near the fitted pose.
std::vector<Pose2> polish_path(std::span<const Pose2> path_W,
                               std::span<const LaserScan> scans,
                               const MapperSettings& settings);

}  // namespace algo
