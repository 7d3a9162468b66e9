// algo/full_strip/mixed_beam.hpp: ends of beams where there may be nothing.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "algo/laser_scan.hpp"

namespace algo {

/// True if a surface through the end of the `i`th beam would run almost along it on one side, and
/// not across it on the other. Many such ends lie between an edge and the surface behind it, both
/// of which the beam met: across a door, for one. A wall seen at a flat angle looks the same, and
/// is seen better from nearer by.
inline bool is_mixed(const LaserScan& scan, std::size_t i) {
  constexpr std::size_t kApart = 2;    // beams: a mixed one is often doubled
  constexpr double kSteep = 6;         // slope along the beam: 9 degrees to it
  constexpr double kLeastStep = 0.08;  // [m]
  const auto ok = [&](std::size_t k) { return scan.status[k] == Beam::Ok; };
  if (i < kApart || i + kApart >= scan.size()) return false;
  if (!ok(i) || !ok(i - kApart) || !ok(i + kApart)) return false;
  const double before = scan.ranges[i] - scan.ranges[i - kApart];
  const double after = scan.ranges[i + kApart] - scan.ranges[i];
  if (before * after <= 0) return false;
  const auto [less, more] = std::minmax({std::abs(before), std::abs(after)});
  const double across = kApart * scan.angle_increment * scan.ranges[i];
  return less > kLeastStep && more > std::max(kLeastStep, kSteep * across);
}

}  // namespace algo
