#include "algo/arm/elbow_circle.hpp"

#include <algorithm>

namespace algo {
namespace {

constexpr double kRounding = 1e-12;  // [m] a stretched arm is within reach
constexpr double kOnAxis = 1e-9;     // part of a unit vector: the wrist is on z0

}  // namespace

WristReach wrist_reach(const ArmGeometry& geometry) {
  return {std::abs(geometry.upper_arm - geometry.lower_arm()),
          geometry.upper_arm + geometry.lower_arm()};
}

std::optional<ElbowCircle> elbow_circle(const ArmGeometry& geometry, const Vec3& wrist) {
  const double distance = wrist.norm();
  const WristReach reach = wrist_reach(geometry);
  // Negated, so that a wrist that is not finite is refused as well.
  if (!(distance > kRounding && distance >= reach.nearest - kRounding &&
        distance <= reach.farthest + kRounding)) {
    return std::nullopt;
  }
  const double upper = geometry.upper_arm;
  const double lower = geometry.lower_arm();
  const double cosine = std::clamp(
      (distance * distance + upper * upper - lower * lower) / (2 * distance * upper), -1.0, 1.0);
  ElbowCircle circle;
  circle.axis = wrist / distance;
  Vec3 down = -Vec3::UnitZ() + circle.axis.z() * circle.axis;
  if (down.norm() < kOnAxis) down = Vec3::UnitX() - circle.axis.x() * circle.axis;
  circle.reference = down.normalized();
  circle.centre = upper * cosine * circle.axis;
  circle.radius = upper * std::sqrt(1 - cosine * cosine);
  return circle;
}

}  // namespace algo
