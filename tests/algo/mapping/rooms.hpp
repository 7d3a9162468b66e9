// tests/algo/mapping/rooms.hpp: a room to map, its scans, and a drive through it; a flat likewise.
#pragma once

#include <cmath>
#include <utility>
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

/// Four rooms of 5 x 5 m about the origin. The walls between them are 0.1 m thick, and each has a
/// door of 1 m.
inline worlds::World flat() {
  worlds::World world;
  const auto add = [&](const algo::Vec2& low, const algo::Vec2& high) {
    world.polygons.push_back({low, {high.x(), low.y()}, high, {low.x(), high.y()}});
  };
  add({-5, -5}, {5, 5});
  for (const auto& [from, to] : {std::pair{-5.0, -3.0}, {-2.0, 2.0}, {3.0, 5.0}}) {
    add({from, -0.05}, {to, 0.05});
    add({-0.05, from}, {0.05, to});
  }
  return world;
}

inline algo::LaserScan scan_at(const algo::Pose2& pose_W, const worlds::World& world = room()) {
  algo::LaserScan scan;
  worlds::scan_world(pose_W, world, 20.0, scan);
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

/// One lap through the doors of the flat, in `steps` poses; the last equals the first.
inline std::vector<algo::Pose2> trip_through_doors(int steps) {
  std::vector<algo::Pose2> path_W;
  for (int k = 0; k <= steps; ++k) {
    const double a = 2 * std::numbers::pi * k / steps;
    path_W.push_back({2.5 * std::sin(a), -2.5 * std::cos(a), algo::wrap_angle(a)});
  }
  return path_W;
}

}  // namespace rooms
