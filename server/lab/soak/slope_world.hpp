// server/lab/soak/slope_world.hpp: random ridges for a robot with a high centre of mass.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "algo/obstacle.hpp"
#include "sim/scenario.hpp"

namespace server::soak {

/// One facet of a ridge's profile.
struct Facet {
  double length = 0;  // [m] on the map
  double slope = 0;   // [rad] up positive
};

/// The facets as ramps, one behind the other along the x axis of `foot_W`, from the floor up;
/// `width` [m] across. Ids from 1.
std::vector<algo::Obstacle> ridge(const algo::Pose2& foot_W,
                                  std::span<const Facet> facets,
                                  double width);

/// Where the robot starts.
enum class SlopeKind : std::uint8_t { Slope, Bank, Crest };
std::string_view name(SlopeKind kind);

/// A ridge of 3 to 12 degrees on either side, of facets that differ by 2 degrees at most from their
/// neighbours, wide enough that nobody falls off its ends. Slope: the robot stands before it, and
/// faces it. Bank: it stands on the slope, and faces along it. Crest: it stands on the top, which
/// has no level part.
struct SlopeWorld {
  sim::Scenario scenario{};
  SlopeKind kind = SlopeKind::Slope;
  double steepest = 0;      // [rad]
  double friction = 0;      // 0.5 to 1
  algo::Stance believed{};  // the robot's file; the true mass is up to 10 % higher or lower
  /// [rad] Between the steepest slope and the one that the standing robot turns over on.
  double margin = 0;
};

/// The same seed gives the same world. The robot is robhaz_tall.
SlopeWorld slope_world(std::uint64_t seed);

}  // namespace server::soak
