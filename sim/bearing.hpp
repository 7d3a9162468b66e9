// sim/bearing.hpp: a fast approximate angle of a vector, to choose the beams worth testing.
#pragma once

#include <cmath>
#include <numbers>

namespace sim {

/// [rad] Largest error of quick_bearing().
constexpr double kQuickBearingError = 2e-6;

/// Angle of (x, y) in [-pi, pi], without a branch. atan on [0, 1] is the first six terms of its
/// Chebyshev series, 2 sum (-1)^k (sqrt(2) - 1)^(2k+1) T_2k+1 / (2k + 1), written as powers. The
/// omitted terms stay below 1.9e-6.
inline double quick_bearing(double x, double y) {
  const double ax = std::abs(x);
  const double ay = std::abs(y);
  const double large = ax > ay ? ax : ay;
  const double small = ax > ay ? ay : ax;
  const double z = large > 0 ? small / large : 0;
  const double z2 = z * z;
  double p = -0.011465809673340864;
  p = p * z2 + 0.05195053207891094;
  p = p * z2 - 0.11572944139573985;
  p = p * z2 + 0.19323529227551817;
  p = p * z2 - 0.3325683165586197;
  p = p * z2 + 0.9999744910973768;
  double angle = p * z;
  angle = ay > ax ? std::numbers::pi / 2 - angle : angle;
  angle = x < 0 ? std::numbers::pi - angle : angle;
  return y < 0 ? -angle : angle;
}

}  // namespace sim
