// server/lab/compare/layouts.hpp: random layouts of obstacles with free gaps of 1 m and more
// between them, the same for the same number on every machine.
//
// The sources have no such layouts. How they are drawn is ours: start, goal and speed of the
// paper's case 3, cylinders and boxes of its sizes, one at least in the robot's way.
#pragma once

#include <cstddef>
#include <vector>

#include "algo/obstacle.hpp"
#include "server/lab/reproduce/study_file.hpp"

namespace server::compare {

constexpr double kFreeGap = 1.0;    // [m] at least, between surfaces
constexpr double kFreeRoom = 1.35;  // [m] from start and goal to a surface: the method's reach
constexpr double kLaneHalf = 0.35;  // [m] the hull's radius: half the robot's way

/// [m] Between the surfaces of two obstacles that do not overlap; not above 0 when they do.
double surface_gap(const algo::Obstacle& a, const algo::Obstacle& b);

/// Layout number `index` of `obstacles` (1 or more): K_c 0.6, `repulsion_gain` K_r, 100 mm/s.
sim::Scenario random_layout(std::size_t obstacles, double repulsion_gain, std::size_t index);

}  // namespace server::compare
