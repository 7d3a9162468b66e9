// server/lab/soak/random_world.hpp: random cluttered rooms.
#pragma once

#include <cstdint>
#include <string>

#include "sim/scenario.hpp"

namespace server::soak {

/// A room of 10 m, closed in two cases of three, with 3 to 24 obstacles of every shape. The start
/// is clear of them by 5 cm. The goal is anywhere: in the open, shut in or inside an obstacle. The
/// same `seed` gives the same world on every machine.
sim::Scenario random_world(std::uint64_t seed, const std::string& controller);

/// True if a disc of `radius` [m] can get from `from_W` to within `reach` [m] of `to_W`. Judged on
/// the true world, on a grid of 5 cm over the room and a margin around it.
bool reachable(const sim::Scenario& scenario,
               const algo::Vec2& from_W,
               const algo::Vec2& to_W,
               double radius,
               double reach);

}  // namespace server::soak
