// algo/terrain/psd_curve.cpp: the curve of sensors.md 7 and its inverse.
#include "algo/terrain/psd_curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace algo {
namespace {

// The reference has L in cm; here it is in m.
constexpr double kDark = 0.09;      // [V] infinitely far away
constexpr double kGain = 0.239;     // [V m]
constexpr double kOffset = 0.0042;  // [m]

constexpr double kPeak = 0.08;      // [m] of the highest voltage
constexpr double kFolded = 0.04;    // [m] which reads as
constexpr double kFoldedAs = 0.20;  // [m]

double far_branch(double distance) {
  return kDark + kGain / (distance + kOffset);
}

}  // namespace

double psd_voltage(double distance) {
  if (distance >= kPeak) return far_branch(distance);
  // A straight line through the two known points.
  const double top = far_branch(kPeak);
  const double rise = (top - far_branch(kFoldedAs)) / (kPeak - kFolded);
  return std::max(0.0, top - rise * (kPeak - distance));
}

double psd_distance(double voltage) {
  if (!(voltage >= kPsdTooFar && voltage <= kPsdTooNear)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return kGain / (voltage - kDark) - kOffset;
}

std::uint16_t psd_counts(double voltage) {
  if (!(voltage > 0)) return 0;
  const double counts = std::round(voltage / kPsdReference * (kPsdMostCounts + 1));
  return static_cast<std::uint16_t>(std::min(counts, double{kPsdMostCounts}));
}

double psd_voltage_of(std::uint16_t counts) {
  return counts * kPsdReference / (kPsdMostCounts + 1);
}

}  // namespace algo
