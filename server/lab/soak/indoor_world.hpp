// server/lab/soak/indoor_world.hpp: random indoor worlds with walking people.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "sim/scenario.hpp"

namespace server::soak {

/// Clutter: a room full of things. Corridors: narrow ways that meet. Doors: rooms joined by doors
/// of 0.9 to 1.2 m. Hall: a few columns with gaps over 2 m.
enum class Indoors : std::uint8_t { Clutter, Corridors, Doors, Hall };
inline constexpr std::array kIndoors{
    Indoors::Clutter, Indoors::Corridors, Indoors::Doors, Indoors::Hall};

/// "clutter"
std::string_view name(Indoors kind);
/// Of that seed; each kind is every fourth.
Indoors indoors_of(std::uint64_t seed);

/// A closed floor of 12 m by 9 m with up to three people, who walk to and fro between two places
/// that see each other, and stand for a second at each. The start is clear by 0.3 m of a robot of
/// `radius` [m]. The same seed gives the same world on every machine.
sim::Scenario indoor_world(std::uint64_t seed, double radius);

}  // namespace server::soak
