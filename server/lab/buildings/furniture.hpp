// server/lab/buildings/furniture.hpp: things that stand in rooms.
#pragma once

#include <vector>

#include "server/lab/buildings/floor_plan.hpp"
#include "sim/random.hpp"

namespace server::buildings {

inline constexpr double kLeg = 0.03;       // [m] thickness of a leg of a table or chair
inline constexpr double kThingGap = 0.85;  // [m] between things, and from things to walls

/// Puts tables and chairs on four legs, cupboards, boxes and columns into every room of `plan` that
/// is 2.4 m wide or more. A thing stands at a wall, or has kThingGap around it; the space before
/// doors stays free. Ids continue those of `obstacles`.
void furnish(const FloorPlan& plan, sim::Random& random, std::vector<algo::Obstacle>& obstacles);

}  // namespace server::buildings
