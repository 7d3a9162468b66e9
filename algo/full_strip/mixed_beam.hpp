// algo/full_strip/mixed_beam.hpp: ends of beams where there may be nothing.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "algo/laser_scan.hpp"

namespace algo {

/// True if no surface is seen at the end of the `i`th beam: the ends beside it lie nearer or
/// farther on both sides, and on one side so much that a surface would run almost along the beam.
/// Many such ends lie between an edge and the surface behind it, both of which the beam met: across
/// a door, or beyond a slit. A wall seen at a flat angle looks the same, and is seen better from
/// nearer by. An end nearer than those on both sides is a thing of its own, such as a leg.
///
/// Beside an outermost beam one side is not known: its end is mixed unless the other side shows its
/// surface.
inline bool is_mixed(const LaserScan& scan, std::size_t i) {
  constexpr std::size_t kApart = 2;    // beams: a mixed one is often doubled
  constexpr double kSteep = 6;         // slope along the beam: 9 degrees to it
  constexpr double kLeastStep = 0.08;  // [m]
  if (scan.size() <= 2 * kApart || scan.status[i] != Beam::Ok) return false;
  const double across = kApart * scan.angle_increment * scan.ranges[i];
  const double steep = std::max(kLeastStep, kSteep * across);
  const auto step_to = [&](std::size_t k) {
    const double range = scan.status[k] == Beam::Ok ? scan.ranges[k] : scan.range_max;
    return range - scan.ranges[i];
  };
  if (i < kApart) return std::abs(step_to(i + kApart)) > steep;
  if (i + kApart >= scan.size()) return std::abs(step_to(i - kApart)) > steep;
  if (scan.status[i - kApart] == Beam::Invalid || scan.status[i + kApart] == Beam::Invalid) {
    return false;
  }
  const double before = step_to(i - kApart);
  const double after = step_to(i + kApart);
  if (before > 0 && after > 0) return false;
  const auto [less, more] = std::minmax({std::abs(before), std::abs(after)});
  return less > kLeastStep && more > steep;
}

}  // namespace algo
