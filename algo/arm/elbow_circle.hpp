// algo/arm/elbow_circle.hpp: the circle on which the elbow may lie while the wrist stays.
#pragma once

#include <optional>

#include "algo/arm/arm_geometry.hpp"

namespace algo {

/// In frame 0. Angles about the axis count from `reference`.
struct ElbowCircle {
  static constexpr double kNone = 1e-9;  // [m] a smaller radius: the elbow is on the axis

  Vec3 centre = Vec3::Zero();
  Vec3 axis = Vec3::UnitZ();       // from the shoulder to the wrist
  Vec3 reference = Vec3::UnitX();  // normal to the axis, on the side of -z0
  double radius = 0;               // [m]

  /// The elbow at arm angle `psi` [rad], turned about the axis by Rodrigues' formula (Eq. 22-25 of
  /// the sibling thesis). At 0 it is the elbow of the six-joint solution, theta_3 = 0.
  Vec3 elbow(double psi) const {
    return centre + radius * (std::cos(psi) * reference + std::sin(psi) * reference.cross(axis));
  }
};

/// The distances from the shoulder at which a wrist can be [m].
struct WristReach {
  double nearest = 0;
  double farthest = 0;
};
WristReach wrist_reach(const ArmGeometry& geometry);

/// None when the arm does not reach `wrist` (in frame 0), or when the wrist is in the shoulder.
std::optional<ElbowCircle> elbow_circle(const ArmGeometry& geometry, const Vec3& wrist);

}  // namespace algo
