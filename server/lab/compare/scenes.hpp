// server/lab/compare/scenes.hpp: who is compared, by which sensor, and in which worlds.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "server/run/run_spec.hpp"
#include "sim/scenario.hpp"

namespace server::compare {

enum class Sensing : std::uint8_t { Laser, Sonar };

/// A controller and what it sees by.
struct Contestant {
  std::string controller{};
  Sensing sensing = Sensing::Laser;
};
/// "vff", "vff by sonar".
std::string label(const Contestant& contestant);

/// Every controller by laser, in the order of the catalog, then those that can by sonar; of these
/// the ones named in `only`, all when it is empty. Throws std::runtime_error naming the unknown.
std::vector<Contestant> contestants(std::span<const std::string> only);

/// The nine worlds of the papers, in their order, as they are built in.
std::vector<sim::Scenario> canonical_scenes();

/// [m] 0.8 to 2.4 in steps of 0.2; the hull is 0.7 m wide.
std::vector<double> bottleneck_gaps();

/// A closed hall, 10 m by 8 m, that a wall with one gap of `gap` [m] parts in two: start and goal
/// 3 m on either side, the gap's middle on the straight line between them. Walls rather than posts:
/// past posts there are other ways, so that reaching the goal would say nothing about the gap. The
/// hall's own walls are farther off than the method's reach.
sim::Scenario bottleneck(double gap);
/// "gap-0800", in millimetres: the name of that scene.
std::string bottleneck_name(double gap);

/// The scene with the contestant in it. By sonar: a ring of 24 in place of the scanners, one ping
/// every 10 ms.
RunSpec make_run(sim::Scenario scene, const Contestant& contestant, std::uint64_t seed);

}  // namespace server::compare
