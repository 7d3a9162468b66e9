// algo/dazzle.hpp: where a scanner tells nothing, because light shines into it or its window is
// bad.
//
// A beam that returned nothing (no echo, farther than the range) or too little (a dark or shining
// wall, which rooms have) has looked. One that was dazzled or in error has not: anything may stand
// there. A dropout here and there is no harm; neighbouring beams that have not looked make a cone
// in which a person can stand unseen.
#pragma once

#include <cstddef>

#include "algo/geometry.hpp"
#include "algo/laser_scan.hpp"
#include "algo/robot.hpp"

namespace algo {

/// Neighbouring beams that have not looked, from which on they are a cone.
inline constexpr std::size_t kLeastCone = 3;

/// The widest cone of `scan`; empty when there is none.
BeamSpan widest_cone(const LaserScan& scan);

/// Whether a cone of `scan` hides a place in the way of the hull: straight ahead, as wide as the
/// hull and a little more, from a hand's breadth before it.
bool hidden(const LaserScan& scan, const RobotSpec& spec);

}  // namespace algo
