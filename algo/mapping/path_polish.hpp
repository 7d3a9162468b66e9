// algo/mapping/path_polish.hpp: lays each scan of a fitted path onto the walls of all scans.
#pragma once

#include <span>
#include <vector>

#include "algo/laser_scan.hpp"
#include "algo/mapping/mapper_settings.hpp"
#include "algo/types.hpp"

namespace algo {

/// Draws the map of all scans along `path_W`, matches each scan to it from its pose on, and repeats
/// this. The fit of the graph spreads errors evenly over the path; this takes out the last
/// centimetres, where walls tell. The map must not grow while scans are matched to it: along a
/// corridor each scan would lean on the one before, and the path would drift by metres. The first
/// pose stays.
std::vector<Pose2> polish_path(std::span<const Pose2> path_W,
                               std::span<const LaserScan> scans,
                               const MapperSettings& settings);

}  // namespace algo
