// algo/units.hpp: literals for the two interfaces that use millimetres and degrees.
#pragma once

#include <numbers>

namespace algo::units {

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

constexpr double operator""_mm(long double v) {
  return static_cast<double>(v) / 1000.0;
}
constexpr double operator""_mm(unsigned long long v) {
  return static_cast<double>(v) / 1000.0;
}
constexpr double operator""_deg(long double v) {
  return static_cast<double>(v) * kRadiansPerDegree;
}
constexpr double operator""_deg(unsigned long long v) {
  return static_cast<double>(v) * kRadiansPerDegree;
}

}  // namespace algo::units
