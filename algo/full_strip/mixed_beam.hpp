// algo/full_strip/mixed_beam.hpp: ends of beams where there may be nothing.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "algo/laser_scan.hpp"

namespace algo {

enum class BeamEnd {
  Surface,  // on a thing
  Between,  // the ends beside it rise or fall through it, almost along the beam
  Beyond,   // it lies farther than the ends beside it
};

/// How the end of the `i`th beam lies to those beside it. Ends between an edge and the surface
/// behind it, both of which the beam met, lie across a door, for one. A wall seen at a flat angle
/// looks the same, and is seen better from nearer by. Ends beyond a slit between two edges lie in a
/// free lane. An end nearer than those on both sides is a thing of its own, such as a leg.
inline BeamEnd beam_end(const LaserScan& scan, std::size_t i) {
  constexpr std::size_t kApart = 2;    // beams: a mixed one is often doubled
  constexpr double kSteep = 6;         // slope along the beam: 9 degrees to it
  constexpr double kLeastStep = 0.08;  // [m]
  const auto ok = [&](std::size_t k) { return scan.status[k] == Beam::Ok; };
  if (i < kApart || i + kApart >= scan.size()) return BeamEnd::Surface;
  if (!ok(i) || !ok(i - kApart) || !ok(i + kApart)) return BeamEnd::Surface;
  // [m] by which it is farther than the ends beside it
  const double past_right = scan.ranges[i] - scan.ranges[i - kApart];
  const double past_left = scan.ranges[i] - scan.ranges[i + kApart];
  if (past_right <= 0 && past_left <= 0) return BeamEnd::Surface;
  const auto [less, more] = std::minmax({std::abs(past_right), std::abs(past_left)});
  const double across = kApart * scan.angle_increment * scan.ranges[i];
  if (less <= kLeastStep || more <= std::max(kLeastStep, kSteep * across)) return BeamEnd::Surface;
  return past_right > 0 && past_left > 0 ? BeamEnd::Beyond : BeamEnd::Between;
}

}  // namespace algo
