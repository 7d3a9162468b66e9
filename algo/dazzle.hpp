// algo/dazzle.hpp: finds beams that were dazzled by light or failed because of a bad window.
//
// A beam without an echo (free within range) or with a weak one (a dark or shining wall, common in
// rooms) did measure. A beam that was dazzled or in error did not: anything may stand there. A
// single dropout is harmless. Neighbouring beams that did not measure form a blind cone that can
// hide a person.
#pragma once

#include <cstddef>

#include "algo/geometry.hpp"
#include "algo/laser_scan.hpp"
#include "algo/robot.hpp"

namespace algo {

/// Neighbouring beams without a measurement count as a cone from this number on.
inline constexpr std::size_t kLeastCone = 3;

/// The widest blind cone of `scan`; empty if there is none.
BeamSpan widest_cone(const LaserScan& scan);

/// True if a blind cone of `scan` hides part of the hull's way. The way is straight ahead, slightly
/// wider than the hull, and begins a hand's breadth ahead of it.
bool hidden(const LaserScan& scan, const RobotSpec& spec);

}  // namespace algo
