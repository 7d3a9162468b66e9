// tests/algo/full_strip/walls.hpp: walls in a map, without a scanner.
#pragma once

#include <vector>

#include "algo/full_strip/local_map.hpp"

namespace walls {

/// Occupies the straight line from `a` to `b`.
inline void wall(algo::LocalMap& map, const algo::Vec2& a, const algo::Vec2& b) {
  algo::LaserScan scan;
  scan.angle_increment = 0.01;
  scan.range_max = 8;
  const auto count = static_cast<std::size_t>((b - a).norm() / 0.02) + 1;
  scan.resize(count);
  std::vector<algo::Vec2> points;
  for (std::size_t i = 0; i < count; ++i) {
    scan.set_ok(i, 0.01);  // clears no cells
    points.push_back(a + (b - a) * (static_cast<double>(i) / static_cast<double>(count)));
  }
  map.insert(scan, {-1000, -1000, 0}, points, {});
}

}  // namespace walls
