#include "algo/arm/arm_chain.hpp"

#include "algo/arm/elbow_circle.hpp"

namespace algo {
namespace {

// Rx(alpha) turns by -90, 0 or 90 degrees: its sine says which, and no cosine of 90 degrees leaves
// a trace of 6e-17.
constexpr std::array<int, kArmJoints> kTwist{-1, -1, 1, -1, 1, -1, 0};

Eigen::Matrix3d link_rotation(double theta, int twist) {
  const double c = std::cos(theta);
  const double s = std::sin(theta);
  Eigen::Matrix3d turn;
  if (twist == 0) {
    turn << c, -s, 0, s, c, 0, 0, 0, 1;
  } else {
    turn << c, 0, twist * s, s, 0, -twist * c, 0, twist, 0;
  }
  return turn;
}

}  // namespace

ArmFrames arm_frames(const ArmGeometry& geometry, const ArmJoints& q) {
  const std::array<double, kArmJoints> along_z{
      0, 0, geometry.upper_arm, 0, geometry.forearm, 0, geometry.hand};
  const std::array<double, kArmJoints> along_x{
      geometry.shoulder_offset, 0, 0, geometry.elbow_offset, 0, 0, 0};
  ArmFrames frames;
  frames.in_shoulder[0] = Pose3::Identity();
  for (std::size_t i = 0; i < kArmJoints; ++i) {
    const double theta = q[static_cast<Eigen::Index>(i)];
    Pose3 link = Pose3::Identity();
    link.linear() = link_rotation(theta, kTwist[i]);
    link.translation() << along_x[i] * std::cos(theta), along_x[i] * std::sin(theta), along_z[i];
    frames.in_shoulder[i + 1] = frames.in_shoulder[i] * link;
  }
  return frames;
}

ArmJacobian arm_jacobian(const ArmFrames& frames) {
  ArmJacobian jacobian;
  jacobian.topRows<3>() = arm_point_jacobian(frames, kArmJoints, frames.hand().translation());
  for (std::size_t i = 0; i < kArmJoints; ++i) {
    jacobian.block<3, 1>(3, static_cast<Eigen::Index>(i)) = frames.in_shoulder[i].linear().col(2);
  }
  return jacobian;
}

PointJacobian arm_point_jacobian(const ArmFrames& frames, std::size_t joints, const Vec3& p) {
  PointJacobian jacobian = PointJacobian::Zero();
  for (std::size_t i = 0; i < std::min(joints, kArmJoints); ++i) {
    const Pose3& before = frames.in_shoulder[i];
    jacobian.col(static_cast<Eigen::Index>(i)) =
        before.linear().col(2).cross(p - before.translation());
  }
  return jacobian;
}

std::optional<double> arm_angle(const ArmGeometry& geometry, const ArmFrames& frames) {
  const auto circle = elbow_circle(geometry, frames.wrist());
  if (!circle || circle->radius < ElbowCircle::kNone) return std::nullopt;
  const Vec3 from_axis = frames.elbow() - circle->centre;
  return std::atan2(from_axis.dot(circle->reference.cross(circle->axis)),
                    from_axis.dot(circle->reference));
}

}  // namespace algo
