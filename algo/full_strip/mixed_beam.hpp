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
/// If there is no end on one side, the other side alone has to show the surface. Beside an
/// outermost beam nothing tells if the end is a thing of its own.
inline bool is_mixed(const LaserScan& scan, std::size_t i) {
  constexpr std::size_t kApart = 2;    // beams: a mixed one is often doubled
  constexpr double kSteep = 6;         // slope along the beam: 9 degrees to it
  constexpr double kLeastStep = 0.08;  // [m]
  const std::size_t size = scan.size();
  if (size <= 2 * kApart || scan.status[i] != Beam::Ok) return false;
  const double across = kApart * scan.angle_increment * scan.ranges[i];
  const double steep = std::max(kLeastStep, kSteep * across);
  const bool first = i < kApart;
  const bool last = i + kApart >= size;
  const bool right = !first && scan.status[i - kApart] == Beam::Ok;
  const bool left = !last && scan.status[i + kApart] == Beam::Ok;
  // [m] by which it is farther than the ends beside it
  const double past_right = right ? scan.ranges[i] - scan.ranges[i - kApart] : 0;
  const double past_left = left ? scan.ranges[i] - scan.ranges[i + kApart] : 0;
  if (!right || !left) {
    const double past = right ? past_right : past_left;
    return (first || last ? std::abs(past) : past) > steep;
  }
  if (past_right < 0 && past_left < 0) return false;
  const auto [less, more] = std::minmax({std::abs(past_right), std::abs(past_left)});
  return less > kLeastStep && more > steep;
}

}  // namespace algo
