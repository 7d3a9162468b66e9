// algo/arm/arm_inverse.hpp: the joints that bring the hand to a pose.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "algo/arm/arm_geometry.hpp"

namespace algo {

/// The eight ways to hold one pose at one arm angle, as three signs.
struct ArmBranch {
  static constexpr std::uint8_t kCount = 8;
  static constexpr std::uint8_t kShoulderBack = 1;  // theta_2 < 0
  static constexpr std::uint8_t kElbowBack = 2;     // theta_4 > 0, exactly when elbow_offset is 0
  static constexpr std::uint8_t kWristBack = 4;     // theta_6 < 0

  std::uint8_t bits = 0;
  bool operator==(const ArmBranch&) const = default;
};

/// The branch that joints `q` [rad] are in.
ArmBranch branch_of(const ArmGeometry& geometry, const ArmJoints& q);

/// Why no joints bring the hand to `hand` (in frame 0), in a sentence with the distances: too far,
/// too near, an offset that the closed form does not know, numbers that are no pose.
std::optional<std::string> unreachable(const ArmGeometry& geometry, const Pose3& hand);

/// The joints, each in (-pi, pi] [rad], with the hand at `hand` (in frame 0) and arm angle `psi`
/// [rad]; they may lie beyond the limits. A joint that the pose does not determine (in a stretched
/// arm) keeps its angle of `present`. None when unreachable().
/// Source: docs/equations.md, "The arm"; Eq. 22-25 of the sibling thesis.
std::optional<ArmJoints> arm_inverse(const ArmGeometry& geometry,
                                     const Pose3& hand,
                                     double psi,
                                     ArmBranch branch,
                                     const ArmJoints& present = ArmJoints::Zero());

struct ArmSolution {
  ArmJoints q = ArmJoints::Zero();
  double psi = 0;  // [rad]
  ArmBranch branch{};
  double margin = 0;  // [rad] see limit_margin()
};

/// Of 72 arm angles, the joints within the limits whose smallest margin is largest; of equal
/// margins the arm angle nearest to the present one. In `branch` alone when it is given, because an
/// arm that moves must not change it. None when the pose is unreachable or no solution keeps the
/// limits.
std::optional<ArmSolution> best_arm_solution(const ArmGeometry& geometry,
                                             const Pose3& hand,
                                             const ArmJoints& present,
                                             std::optional<ArmBranch> branch = std::nullopt);

}  // namespace algo
