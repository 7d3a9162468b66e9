// algo/ring_axes.hpp: the ring of sonars in front that the laws for driving by hand read (Park et
// al. 2005, section 2.1).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "algo/types.hpp"
#include "algo/units.hpp"

namespace algo {

constexpr std::size_t kRingSonars = 8;
constexpr double kRingHalfCone = 15 * units::kRadiansPerDegree;  // [rad]
constexpr double kOldestEcho = 0.1;  // [s] all sonars of the ring have measured within this time

/// theta_n [rad] in R: the axes, evenly over the half circle ahead, from right to left.
constexpr std::array<double, kRingSonars> ring_bearings() {
  std::array<double, kRingSonars> bearings{};
  for (std::size_t n = 0; n < kRingSonars; ++n) {
    const double share = static_cast<double>(n) / static_cast<double>(kRingSonars - 1);
    bearings[n] = (share - 0.5) * std::numbers::pi;
  }
  return bearings;
}

/// True if a return at `bearing` lies in the cone of a sonar with that axis. Both [rad] in R.
inline bool in_cone(double axis, double bearing) {
  return std::abs(wrap_angle(bearing - axis)) <= kRingHalfCone;
}

}  // namespace algo
