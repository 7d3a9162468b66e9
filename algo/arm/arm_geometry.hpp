// algo/arm/arm_geometry.hpp: lengths and limits of an arm of seven joints.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "algo/types.hpp"
#include "algo/units.hpp"

namespace algo {

inline constexpr std::size_t kArmJoints = 7;

/// One value for each joint, the shoulder's first [rad, rad/s].
using ArmJoints = Eigen::Matrix<double, static_cast<int>(kArmJoints), 1>;

/// Position and attitude in three dimensions of a frame in its parent.
using Pose3 = Eigen::Isometry3d;

/// The limits of all joints to either side of zero [rad]. The source names none.
inline ArmJoints silvermate_joint_limits() {
  ArmJoints degrees;
  degrees << 170, 120, 170, 140, 170, 110, 175;
  return degrees * units::kRadiansPerDegree;
}

/// A shoulder, an elbow and a wrist with three, one and three joints. The source's table is
/// damaged; these lengths are chosen. Parameters of Denavit and Hartenberg: docs/equations.md, "The
/// arm".
struct ArmGeometry {
  double shoulder_offset = 0;  // [m] a1; the inverse below wants 0: the mount holds an offset
  double upper_arm = 0.30;     // [m] d3, shoulder to elbow
  double elbow_offset = 0;     // [m] a4
  double forearm = 0.28;       // [m] d5, elbow to wrist
  double hand = 0.15;          // [m] d7, wrist to hand
  ArmJoints limits = silvermate_joint_limits();

  /// [m] elbow to wrist, past the offset.
  double lower_arm() const { return std::hypot(elbow_offset, forearm); }
};

/// Why no arm can have this geometry: a length that is not above 0, a limit outside (0, 180]
/// degrees, a number that is not finite.
std::optional<std::string> objection(const ArmGeometry& geometry);

/// Smallest distance of a joint to its limit [rad]; below 0 when a joint is beyond it.
double limit_margin(const ArmGeometry& geometry, const ArmJoints& q);

}  // namespace algo
