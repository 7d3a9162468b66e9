// tests/algo/pipeline/arm_guard_test.cpp: commands beside a thing, for an arm that stands or moves.
#include "algo/pipeline/arm_guard.hpp"

#include <array>

#include <gtest/gtest.h>

namespace {

using algo::ArmGuard;
using algo::Vec2;

algo::RobotSpec guarded_spec() {
  algo::RobotSpec spec;
  spec.radius = 0.35;
  spec.period = 0.026;
  spec.max_acceleration = 0.5;
  spec.max_angular_acceleration = 4;
  spec.max_v = 0.5;
  spec.max_omega = 1;
  spec.arm.emplace();
  return spec;
}

TEST(ArmGuard, CountsTheMotionThatAJointStillHas) {
  const algo::RobotSpec spec = guarded_spec();
  const ArmGuard guard(spec);
  const algo::MobileArm body = mobile_arm(*spec.arm, spec.radius);
  algo::ArmJoints q = algo::ArmJoints::Zero();
  q[1] = std::numbers::pi / 2;  // stretched out
  const algo::BodyJoints now = algo::body_joints({}, q);
  const algo::BodyFrames frames = body_frames(body, now);
  const Vec2 out = (frames.hand() - frames.shoulder()).head<2>().normalized();
  algo::Solid post;  // beside the hand, where the first joint turns it
  post.rounding = 0.05;
  post.bottom = 0.5;
  post.top = 1.5;
  post.centre_W = frames.hand().head<2>() + (0.06 + 0.05 + 0.04) * Vec2(-out.y(), out.x());
  algo::Command slowly;
  slowly.joints = algo::kArmJoints;
  slowly.joint_rates[0] = 0.3;
  ArmGuard::Motion motion;
  EXPECT_EQ(guard.limited(now, motion, std::array{post}, slowly), slowly);
  motion.rates[0] = 1.5;
  const algo::Command held = guard.limited(now, motion, std::array{post}, slowly);
  EXPECT_EQ(held.joint_rates, algo::Command{}.joint_rates);
}

/// Without a margin it came to a touch, by a millimetre in each tick.
TEST(ArmGuard, ABaseThatIsDrivenAtAWallAgainAndAgainStaysOffIt) {
  const algo::RobotSpec spec = guarded_spec();
  const ArmGuard guard(spec);
  algo::Solid wall;
  wall.half = {0.05, 2};
  wall.centre_W = {spec.radius + 0.10 + wall.half.x(), 0};
  wall.top = 1.4;
  const algo::ArmJoints folded = Eigen::Map<const algo::ArmJoints>(spec.arm->rest.data());
  algo::Command ahead;
  ahead.base.v = 0.3;
  ahead.joints = algo::kArmJoints;
  algo::MotionState state;
  for (int tick = 0; tick < 400; ++tick) {
    const algo::BodyJoints now = algo::body_joints(state.pose_W, folded);
    const algo::Command passed = guard.limited(now, {.base = state.twist}, std::array{wall}, ahead);
    state = advanced(state, passed.base, limits_of(spec), spec.period);
  }
  const double gap = 0.10 - state.pose_W.x;
  EXPECT_GT(gap, 0.005);
  EXPECT_LT(gap, 0.05);
}

}  // namespace
