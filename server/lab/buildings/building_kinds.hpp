// server/lab/buildings/building_kinds.hpp: the floor plan of each kind of building.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "server/lab/buildings/floor_plan.hpp"
#include "sim/random.hpp"

namespace server::buildings {

/// Maze: corridors of one width with few loops. Flat: rooms joined by doors. Office: rooms on both
/// sides of a long corridor. Hall: one to three large halls. Dead ends: long lanes of which one
/// leads on. Spiral: one way that turns inwards.
enum class Kind : std::uint8_t { Maze, Flat, Office, Hall, DeadEnds, Spiral };
inline constexpr std::array kKinds{
    Kind::Maze, Kind::Flat, Kind::Office, Kind::Hall, Kind::DeadEnds, Kind::Spiral};
/// "dead_ends"
std::string_view name(Kind kind);
/// Throws std::invalid_argument that lists the names.
Kind kind_named(std::string_view name);

/// A plan without furniture.
FloorPlan draw_plan(Kind kind, double door_width, sim::Random& random);

}  // namespace server::buildings
