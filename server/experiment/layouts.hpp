// server/experiment/layouts.hpp: random layouts of obstacles with free gaps between them. The same
// rules and index give the same layout on every machine.
//
// The sources have no such layouts. The rules for drawing them are ours: start, goal and speed of
// the paper's case 3, cylinders and boxes of its sizes, at least one of them in the robot's way.
#pragma once

#include <cstddef>
#include <vector>

#include "algo/obstacle.hpp"
#include "sim/scenario.hpp"

namespace server::experiment {

constexpr double kFreeGap = 1.0;    // [m] least gap between surfaces, unless another is asked for
constexpr double kFreeRoom = 1.35;  // [m] from start and goal to a surface: the method's reach
constexpr double kLaneHalf = 0.35;  // [m] the hull's radius: half the width of the robot's lane

/// [m] Gap between the surfaces of two obstacles; 0 or less if they overlap.
double surface_gap(const algo::Obstacle& a, const algo::Obstacle& b);

constexpr double kAside = 2.0;  // [m] farthest centre from the straight line, unless asked for

struct LayoutRules {
  std::size_t obstacles = 3;    // 1 or more
  double repulsion_gain = 0.3;  // K_r
  double gap = kFreeGap;        // [m] least gap between surfaces
  double aside = kAside;        // [m] farthest centre from the straight line
};

/// [m2] The band along the straight line in which the centres lie.
double area_of(const LayoutRules& rules);

/// Layout number `index`: K_c 0.6, 100 mm/s. Throws std::runtime_error with a sentence if so many
/// obstacles with such gaps find no place.
sim::Scenario random_layout(const LayoutRules& rules, std::size_t index);

}  // namespace server::experiment
