// algo/terrain/ground_class.cpp: the classifier's table.
#include "algo/terrain/ground_class.hpp"

#include <array>
#include <cmath>

#include "algo/terrain/psd_curve.hpp"

namespace algo {
namespace {

constexpr std::array<std::string_view, kGroundClasses> kClassNames{
    "slope_up", "slope_down", "step_up", "step_down", "trench", "flat", "pending", "unknown"};

bool in_range(double distance) {
  return distance >= kPsdNearest && distance <= kPsdFarthest;  // false for NaN
}

}  // namespace

std::string_view name(GroundClass kind) {
  return kClassNames.at(static_cast<std::size_t>(kind));
}

FlatRanges flat_ranges(const FloorSensors& sensors) {
  const double near = sensors.height / std::sin(sensors.angle);
  return {near + sensors.separation / std::tan(sensors.angle), near};
}

GroundClass classify(double a, double b, const GroundThresholds& limits) {
  if (!std::isfinite(a) || !std::isfinite(b)) return GroundClass::Unknown;
  const double both = limits.far + limits.near;
  const bool far_level = std::abs(a) <= limits.far;
  if (std::abs(b) <= limits.near) {
    return far_level ? GroundClass::Flat : GroundClass::Pending;  // Eq. 5
  }
  // Eq. 8, and Eq. 7b: a ridge narrower than the distance between the beams.
  if (far_level) return b > 0 ? GroundClass::Trench : GroundClass::StepUp;
  if ((a > 0) != (b > 0)) return GroundClass::Unknown;
  if (std::abs(a - b) <= both) {
    return a > 0 ? GroundClass::StepDown : GroundClass::StepUp;  // Eq. 6, Eq. 7a
  }
  if (a > 0 && a - b > both) return GroundClass::SlopeDown;  // Eq. 9
  if (a < 0 && a - b < -both) return GroundClass::SlopeUp;   // Eq. 10
  return GroundClass::Unknown;
}

GroundClass classify_ranges(double far,
                            double near,
                            const FlatRanges& flat,
                            const GroundThresholds& limits) {
  if (!in_range(far) || !in_range(near)) return GroundClass::Unknown;
  return classify(far - flat.far, near - flat.near, limits);
}

unsigned classify_literal(double a, double b, const GroundThresholds& limits) {
  const double both = limits.far + limits.near;
  unsigned found = 0;
  const auto holds = [&found](GroundClass kind, bool rule) {
    if (rule) found |= 1U << static_cast<unsigned>(kind);
  };
  const bool far_level = std::abs(a) <= limits.far;
  const bool near_level = std::abs(b) <= limits.near;
  const bool both_off = std::abs(a) > limits.far && std::abs(b) > limits.near;
  holds(GroundClass::Flat, far_level && near_level);                                  // Eq. 5
  holds(GroundClass::StepDown, a > limits.far && b > limits.near && a - b < both);    // Eq. 6
  const bool raised = a < -limits.far && b < -limits.near && std::abs(a - b) < both;  // Eq. 7a
  holds(GroundClass::StepUp, raised || (far_level && b < -limits.near));              // Eq. 7b
  holds(GroundClass::Trench, far_level && b > limits.near);                           // Eq. 8
  holds(GroundClass::SlopeDown, both_off && a - b > both);                            // Eq. 9
  holds(GroundClass::SlopeUp, both_off && a - b < both);                              // Eq. 10
  return found;
}

}  // namespace algo
