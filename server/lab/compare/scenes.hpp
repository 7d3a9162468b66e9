// server/lab/compare/scenes.hpp: the contestants, their sensors and their worlds.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "server/run/run_spec.hpp"
#include "sim/scenario.hpp"

namespace server::compare {

enum class Sensing : std::uint8_t { Laser, Sonar };

/// A controller and its sensor.
struct Contestant {
  std::string controller{};
  Sensing sensing = Sensing::Laser;
};
/// "vff", "vff by sonar".
std::string label(const Contestant& contestant);

/// Every controller by laser, in the order of the catalog, then by sonar those that can use it.
/// Keeps the controllers named in `only`, or all if it is empty. Throws std::runtime_error naming
/// an unknown one.
std::vector<Contestant> contestants(std::span<const std::string> only);

/// The papers' nine worlds from the built-in scenarios, in the papers' order.
std::vector<sim::Scenario> canonical_scenes();

/// [m] 0.8 to 2.4 in steps of 0.2; the hull is 0.7 m wide.
std::vector<double> bottleneck_gaps();

/// A closed hall, 10 m by 8 m, divided by a wall with one gap of `gap` [m]. Start and goal are 3 m
/// from the wall on either side, and the gap's middle is on the straight line between them. Walls
/// rather than posts: a robot could drive around posts, and reaching the goal would say nothing
/// about the gap. The hall's outer walls are beyond the method's reach.
sim::Scenario bottleneck(double gap);
/// The name of that scene, with the gap in millimetres: "gap-0800".
std::string bottleneck_name(double gap);

/// The scene with the contestant in it. For sonar a ring of 24 replaces the scanners, with one ping
/// every 10 ms.
RunSpec make_run(sim::Scenario scene, const Contestant& contestant, std::uint64_t seed);

}  // namespace server::compare
