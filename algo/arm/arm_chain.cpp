#include "algo/arm/arm_chain.hpp"

#include "algo/arm/elbow_circle.hpp"

namespace algo {
namespace {

// Rx(alpha) turns by -90, 0 or 90 degrees: its sine says which, and no cosine of 90 degrees leaves
// a trace of 6e-17.
constexpr std::array<int, kArmJoints> kTwist{-1, -1, 1, -1, 1, -1, 0};

/// `before` times A_i, where twist is the sine of alpha_i.
Pose3 after_joint(const Pose3& before, double theta, int twist, double along_z, double along_x) {
  const double c = std::cos(theta);
  const double s = std::sin(theta);
  const Vec3 x = before.linear().col(0);
  const Vec3 y = before.linear().col(1);
  const Vec3 z = before.linear().col(2);
  Pose3 after;
  after.makeAffine();
  after.linear().col(0) = c * x + s * y;
  if (twist == 0) {
    after.linear().col(1) = c * y - s * x;
    after.linear().col(2) = z;
  } else {
    after.linear().col(1) = twist * z;
    after.linear().col(2) = twist * (s * x - c * y);
  }
  after.translation() = before.translation() + along_z * z + along_x * after.linear().col(0);
  return after;
}

}  // namespace

ArmFrames arm_frames(const ArmGeometry& geometry,
                     const ArmJoints& q,
                     const Pose3& shoulder,
                     std::size_t joints) {
  const std::array<double, kArmJoints> along_z{
      0, 0, geometry.upper_arm, 0, geometry.forearm, 0, geometry.hand};
  const std::array<double, kArmJoints> along_x{
      geometry.shoulder_offset, 0, 0, geometry.elbow_offset, 0, 0, 0};
  ArmFrames frames;
  frames[0] = shoulder;
  for (std::size_t i = 0; i < joints; ++i) {
    frames[i + 1] =
        after_joint(frames[i], q[static_cast<Eigen::Index>(i)], kTwist[i], along_z[i], along_x[i]);
  }
  return frames;
}

ArmJacobian arm_jacobian(const ArmFrames& frames) {
  ArmJacobian jacobian;
  jacobian.topRows<3>() = arm_point_jacobian(frames, kArmJoints, frames.hand().translation());
  for (std::size_t i = 0; i < kArmJoints; ++i) {
    jacobian.block<3, 1>(3, static_cast<Eigen::Index>(i)) = frames[i].linear().col(2);
  }
  return jacobian;
}

PointJacobian arm_point_jacobian(const ArmFrames& frames, std::size_t joints, const Vec3& p) {
  PointJacobian jacobian = PointJacobian::Zero();
  for (std::size_t i = 0; i < std::min(joints, kArmJoints); ++i) {
    const Pose3& before = frames[i];
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
