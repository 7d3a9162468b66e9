// algo/arm/arm_geometry.hpp: lengths and limits of an arm of seven joints.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "algo/arm_spec.hpp"
#include "algo/types.hpp"

namespace algo {

/// One value for each joint, the shoulder's first [rad, rad/s].
using ArmJoints = Eigen::Matrix<double, static_cast<int>(kArmJoints), 1>;

/// Position and attitude in three dimensions of a frame in its parent.
using Pose3 = Eigen::Isometry3d;

inline ArmJoints joints_of(const JointValues& values) {
  return Eigen::Map<const ArmJoints>(values.data());
}
inline JointValues values_of(const ArmJoints& joints) {
  JointValues values{};
  Eigen::Map<ArmJoints>(values.data()) = joints;
  return values;
}

/// A shoulder, an elbow and a wrist with three, one and three joints. Parameters of Denavit and
/// Hartenberg: docs/equations.md, "The arm". The defaults are those of ArmSpec.
struct ArmGeometry {
  double shoulder_offset = 0;  // [m] a1; the inverse below wants 0: the mount holds an offset
  double upper_arm = ArmSpec{}.upper_arm;        // [m] d3, shoulder to elbow
  double elbow_offset = ArmSpec{}.elbow_offset;  // [m] a4
  double forearm = ArmSpec{}.forearm;            // [m] d5, elbow to wrist
  double hand = ArmSpec{}.hand;                  // [m] d7, wrist to hand
  ArmJoints limits = joints_of(ArmSpec{}.limits);

  /// [m] elbow to wrist, past the offset.
  double lower_arm() const { return std::hypot(elbow_offset, forearm); }
};

/// Why no arm can have this geometry: a length that is not above 0, a limit outside (0, 180]
/// degrees, a number that is not finite.
std::optional<std::string> objection(const ArmGeometry& geometry);

/// Smallest distance of a joint to its limit [rad]; below 0 when a joint is beyond it.
double limit_margin(const ArmGeometry& geometry, const ArmJoints& q);

}  // namespace algo
