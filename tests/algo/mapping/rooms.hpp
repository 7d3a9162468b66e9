// tests/algo/mapping/rooms.hpp: a room to map, its scans, and a drive through it; a hall likewise.
#pragma once

#include <cmath>
#include <numbers>
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

/// A room of 6 x 6 m about the origin within a hall. Its walls are 0.1 m thick, and the south one
/// has a door of 1 m.
inline worlds::World room_in_hall() {
  worlds::World world;
  const auto add = [&](const algo::Vec2& low, const algo::Vec2& high) {
    world.polygons.push_back({low, {high.x(), low.y()}, high, {low.x(), high.y()}});
  };
  add({-7, -7}, {7, 7});
  add({-3.1, -3.1}, {-0.5, -3});
  add({0.5, -3.1}, {3.1, -3});
  add({-3.1, 3}, {3.1, 3.1});
  add({-3.1, -3}, {-3, 3});
  add({3, -3}, {3.1, 3});
  return world;
}

/// A corridor 2 m wide around a block of 36 x 36 m about the origin, with a niche in each side of
/// the block.
inline worlds::World ring() {
  worlds::World world;
  std::vector<algo::Vec2> block;
  for (int side = 0; side < 4; ++side) {
    const algo::Pose2 turned{0, 0, side * std::numbers::pi / 2};
    const double niche = -12 + 7.0 * side;
    for (const algo::Vec2& p : {algo::Vec2(-18, -18),
                                algo::Vec2(niche, -18),
                                algo::Vec2(niche, -16.5),
                                algo::Vec2(niche + 1.5, -16.5),
                                algo::Vec2(niche + 1.5, -18)}) {
      block.push_back(to_parent(turned, p));
    }
  }
  world.polygons = {block, {{-20, -20}, {20, -20}, {20, 20}, {-20, 20}}};
  return world;
}

/// Around ring() in the middle of its corridor, from the middle of its south side to 16 m past it.
inline std::vector<algo::Pose2> around_ring() {
  constexpr double kHalf = 19;  // [m] of a side
  constexpr int kSteps = 380;
  constexpr int kTurns = 16;
  std::vector<algo::Pose2> path_W;
  for (int side = 0; side <= 4; ++side) {
    const algo::Pose2 turned{0, 0, side * std::numbers::pi / 2};
    const int last = side == 4 ? kSteps / 2 + 160 : kSteps;
    for (int k = side == 0 ? kSteps / 2 : 0; k <= last; ++k) {
      path_W.push_back(compose(turned, {-kHalf + 2 * kHalf * k / kSteps, -kHalf, 0}));
    }
    for (int k = 1; side < 4 && k < kTurns; ++k) {
      path_W.push_back(compose(turned, {kHalf, -kHalf, k * std::numbers::pi / (2 * kTurns)}));
    }
  }
  return path_W;
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

/// Once around the room in the hall, then `laps` laps within it.
inline std::vector<algo::Pose2> round_and_in(int laps) {
  std::vector<algo::Pose2> path_W;
  const auto circle = [&](double radius, int steps, int turns) {
    for (int k = 0; k <= steps * turns; ++k) {
      const double a = 2 * std::numbers::pi * k / steps;
      path_W.push_back({radius * std::sin(a), -radius * std::cos(a), algo::wrap_angle(a)});
    }
  };
  circle(5, 160, 1);
  for (int k = 0; k <= 20; ++k) path_W.push_back({0, -5 + 0.175 * k, std::numbers::pi / 2});
  circle(1.5, 60, laps);
  return path_W;
}

}  // namespace rooms
