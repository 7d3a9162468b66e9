// algo/terrain/ground_value.cpp: Eq. 11-14.
#include "algo/terrain/ground_value.hpp"

#include <cmath>
#include <numbers>

namespace algo {

double ground_height(double near, double near_flat, double alpha) {
  return (near_flat - near) * std::sin(alpha);
}

double trench_width(double near, double near_flat, double alpha) {
  return (near - near_flat) * std::cos(alpha);
}

double ground_slope(double far, double near, double separation, double alpha) {
  return std::numbers::pi / 2 - alpha - std::atan2(far - near, separation);
}

}  // namespace algo
