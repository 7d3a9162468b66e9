// tests/algo/mapping/rooms.hpp: a room to map, its scans, and a drive through it.
#pragma once

#include <cmath>
#include <vector>

#include "tests/algo/worlds.hpp"

#include "algo/laser_scan.hpp"
#include "algo/types.hpp"

namespace rooms {

/// 12 x 8 m with a recess, a pillar and two cupboards.
inline worlds::World room() {
  worlds::World world;
  world.polygons = {{{-2, -3}, {10, -3}, {10, 1}, {8.5, 1}, {8.5, 3}, {10, 3}, {10, 5}, {-2, 5}},
                    {{3, 3.6}, {4.8, 3.6}, {4.8, 4.2}, {3, 4.2}},
                    {{5, -2.2}, {6.1, -2.2}, {6.1, -1.4}, {5, -1.4}}};
  world.circles = {{{1.5, 2.5}, 0.35}};
  return world;
}

inline algo::LaserScan scan_at(const algo::Pose2& pose_W) {
  algo::LaserScan scan;
  worlds::scan_world(pose_W, room(), 20.0, scan);
  return scan;
}

/// One lap of an ellipse in the room, in `steps` poses; the last equals the first.
inline std::vector<algo::Pose2> round_trip(int steps) {
  std::vector<algo::Pose2> path_W;
  for (int k = 0; k <= steps; ++k) {
    const double a = 2 * std::numbers::pi * k / steps;
    path_W.push_back({4 + 3.0 * std::sin(a), 0.6 - 1.2 * std::cos(a), 0});
    path_W.back().heading = std::atan2(1.2 * std::sin(a), 3.0 * std::cos(a));
  }
  return path_W;
}

}  // namespace rooms
