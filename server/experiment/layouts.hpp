// server/experiment/layouts.hpp: random layouts of obstacles with free gaps of at least 1 m
// between them. The same index gives the same layout on every machine.
//
// The sources have no such layouts. The rules for drawing them are ours: start, goal and speed of
// the paper's case 3, cylinders and boxes of its sizes, at least one of them in the robot's way.
#pragma once

#include <cstddef>
#include <vector>

#include "algo/obstacle.hpp"
#include "sim/scenario.hpp"

namespace server::experiment {

constexpr double kFreeGap = 1.0;    // [m] least gap between surfaces
constexpr double kFreeRoom = 1.35;  // [m] from start and goal to a surface: the method's reach
constexpr double kLaneHalf = 0.35;  // [m] the hull's radius: half the width of the robot's lane

/// [m] Gap between the surfaces of two obstacles; 0 or less if they overlap.
double surface_gap(const algo::Obstacle& a, const algo::Obstacle& b);

/// Layout number `index` of `obstacles` (1 or more): K_c 0.6, `repulsion_gain` K_r, 100 mm/s.
sim::Scenario random_layout(std::size_t obstacles, double repulsion_gain, std::size_t index);

}  // namespace server::experiment
