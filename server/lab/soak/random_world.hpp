// server/lab/soak/random_world.hpp: cluttered rooms nobody drew.
#pragma once

#include <cstdint>
#include <string>

#include "sim/scenario.hpp"

namespace server::soak {

/// A room of 10 m, closed in two of three, with 3 to 24 obstacles of every shape, a start that is
/// clear of them by 5 cm and a goal anywhere: in the open, shut in or inside an obstacle. The same
/// `seed` gives the same world on every machine.
sim::Scenario random_world(std::uint64_t seed, const std::string& controller);

/// Whether a disc of `radius` [m] can come from `from_W` to within `reach` [m] of `to_W`; judged on
/// the true world, in steps of 5 cm over the room and a margin around it.
bool reachable(const sim::Scenario& scenario,
               const algo::Vec2& from_W,
               const algo::Vec2& to_W,
               double radius,
               double reach);

}  // namespace server::soak
