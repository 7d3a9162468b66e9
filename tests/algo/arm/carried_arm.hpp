// tests/algo/arm/carried_arm.hpp: an arm carried along a straight way, stretched out to the right,
// past a post.
#pragma once

#include <stdexcept>
#include <vector>

#include "algo/arm/arm_inverse.hpp"
#include "algo/arm/mobile_arm.hpp"

namespace carried_arm {

/// At the origin, with the hand `reach` [m] to the right of the shoulder and at its height.
inline algo::BodyJoints stretched_aside(double reach) {
  const algo::MobileArm body;
  algo::Pose3 hand = algo::Pose3::Identity();
  hand.linear() << 1, 0, 0, 0, 0, -1, 0, 1, 0;  // the tool points to the right
  hand.translation() = algo::Vec3(0, -reach, 0);
  const auto best = best_arm_solution(body.arm, hand, algo::ArmJoints::Constant(0.3));
  if (!best) throw std::runtime_error("the hand does not get there");
  return algo::body_joints({}, best->q);
}

/// 4 m along x.
inline std::vector<algo::BodyJoints> straight_path(double reach, std::size_t configurations = 21) {
  std::vector<algo::BodyJoints> path(configurations, stretched_aside(reach));
  for (std::size_t i = 0; i < configurations; ++i) {
    path[i][0] = 4.0 * static_cast<double>(i) / static_cast<double>(configurations - 1);
  }
  return path;
}

/// Half way, with its centre `inside` [m] the hand.
inline algo::Solid post_before_arm(double reach, double inside) {
  algo::Solid post;
  post.centre_W = {2, -0.22 - reach + inside};
  post.rounding = 0.10;
  post.bottom = 0;
  post.top = 1.6;
  return post;
}

}  // namespace carried_arm
