// algo/arm/arm_chain.hpp: where the links of an arm are, and how they move with its joints.
#pragma once

#include <array>
#include <optional>

#include "algo/arm/arm_geometry.hpp"

namespace algo {

/// Frame 0 at the shoulder and frames 1 to 7 behind the joints; frame 7 is the hand.
struct ArmFrames : std::array<Pose3, kArmJoints + 1> {
  Vec3 shoulder() const { return front().translation(); }
  Vec3 elbow() const { return (*this)[3].translation(); }
  Vec3 wrist() const { return (*this)[5].translation(); }
  const Pose3& hand() const { return back(); }
};

/// The product of A_i = Rz(theta_i) Tz(d_i) Tx(a_i) Rx(alpha_i) for joints `q` [rad], in the frame
/// in which `shoulder` is frame 0. Frames beyond joint `joints` are not computed.
/// Source: the sibling thesis' table of parameters, of which A_1 survives; docs/equations.md, "J.
/// The arm".
ArmFrames arm_frames(const ArmGeometry& geometry,
                     const ArmJoints& q,
                     const Pose3& shoulder = Pose3::Identity(),
                     std::size_t joints = kArmJoints);

/// Velocity [m/s] and turn rate [rad/s] of the hand, for joint rates [rad/s]; in the frame in which
/// the ArmFrames are given.
using ArmJacobian = Eigen::Matrix<double, 6, static_cast<int>(kArmJoints)>;

/// Column i: (z_{i-1} x (p - p_{i-1}), z_{i-1}), with p the hand.
ArmJacobian arm_jacobian(const ArmFrames& frames);

/// Velocity [m/s] of a point, for joint rates [rad/s]; in the frame in which the ArmFrames are
/// given.
using PointJacobian = Eigen::Matrix<double, 3, static_cast<int>(kArmJoints)>;

/// The Jacobian of a point `p` that is fixed to the link behind joint `joints`: later joints do not
/// move it, so their columns are 0.
PointJacobian arm_point_jacobian(const ArmFrames& frames, std::size_t joints, const Vec3& p);

/// Arm angle psi [rad]: how far the elbow is turned about the line from shoulder to wrist, from the
/// side where theta_3 is 0. None where the elbow lies on this line and may be anywhere.
/// `frames` are those of frame 0.
std::optional<double> arm_angle(const ArmGeometry& geometry, const ArmFrames& frames);

}  // namespace algo
