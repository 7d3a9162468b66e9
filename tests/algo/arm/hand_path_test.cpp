// tests/algo/arm/hand_path_test.cpp: the hand on its path, and the base beside things.
#include "algo/arm/hand_path.hpp"

#include <array>

#include "tests/algo/allocations.hpp"
#include "tests/algo/arm/carried_arm.hpp"
#include <gtest/gtest.h>

#include "algo/arm/arm_inverse.hpp"

namespace {

using algo::BodyJoints;
using algo::HandPath;
using algo::Vec3;

constexpr double kPathTick = 0.05;  // [s]

/// A hand that begins 0.55 m right of the shoulder and points that way, and goes straight on.
struct PathDrive {
  explicit PathDrive(const algo::HandPathRules& rules = {}, bool base_stays = false)
      : path(body, {}, rules) {
    algo::Pose3 hand = algo::Pose3::Identity();
    hand.linear() = Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitX()).toRotationMatrix();
    hand.translation() = Vec3(0.1, -0.5, -0.05);
    q = algo::body_joints({}, best_arm_solution(body.arm, hand, body.folded)->q);
    from_W = body_frames(body, q).hand();
    to_W = from_W + Vec3(base_stays ? 0.2 : 2.0, 0, 0);
    path.begin(q, body_frames(body, q).arm_W.hand().linear(), std::array{to_W}, base_stays);
  }
  bool run(std::span<const algo::Solid> solids = {}, double longest = 60) {
    for (double time = 0; time < longest; time += kPathTick) {
      const algo::BodyCommand command = path.update(q, solids, kPathTick);
      if (command.state == algo::FollowState::Arrived) return true;
      q = moved(q, command, kPathTick);
      const algo::BodyFrames frames = body_frames(body, q);
      const Vec3 off = frames.hand() - from_W;
      aside = std::max({aside, std::abs(off.y()), std::abs(off.z())});
      room = std::min(room, clearance(body, frames, solids).smallest());
      own_room = std::min(own_room, self_clearance(body, frames));
    }
    return false;
  }
  double hand_error() const { return (body_frames(body, q).hand() - to_W).norm(); }

  algo::MobileArm body{};
  HandPath path;
  BodyJoints q = BodyJoints::Zero();
  Vec3 from_W = Vec3::Zero();
  Vec3 to_W = Vec3::Zero();
  double aside = 0;       // [m] of the hand from its line
  double room = 1e9;      // [m]
  double own_room = 1e9;  // [m]
};

algo::Solid low_post(double x, double y) {
  algo::Solid post;
  post.centre_W = {x, y};
  post.rounding = 0.08;
  post.bottom = 0;
  post.top = 0.5;
  return post;
}

TEST(HandPath, LeadsTheHandAlongItsLineAndTheBaseBesideIt) {
  PathDrive drive;
  EXPECT_TRUE(drive.run());
  EXPECT_LT(drive.hand_error(), 0.005);
  EXPECT_LT(drive.aside, 0.005);
  EXPECT_GT(drive.q[0], 1.0) << "the base has come along";
  EXPECT_GT(drive.own_room, 0.01);
}

TEST(HandPath, TheBaseGivesWayToAPostAndTheHandDoesNot) {
  const std::array post{low_post(1.2, 0.38)};
  algo::HandPathRules blind;
  blind.push = 0;
  PathDrive printed(blind);
  printed.run(post);
  EXPECT_LT(printed.room, 0.02);
  PathDrive drive;
  EXPECT_TRUE(drive.run(post));
  EXPECT_LT(drive.aside, 0.01);
  EXPECT_GT(drive.room, 0.08);
  EXPECT_GT(drive.own_room, 0.01);
}

TEST(HandPath, TheArmAloneGoesWhereTheBaseStays) {
  PathDrive drive({}, true);
  const BodyJoints before = drive.q;
  EXPECT_TRUE(drive.run());
  EXPECT_EQ(drive.q.head<3>(), before.head<3>());
  EXPECT_LT(drive.aside, 0.005);
}

TEST(HandPath, ATickAllocatesNothing) {
  PathDrive drive;
  const std::array post{low_post(1.2, 0.38)};
  drive.path.update(drive.q, post, kPathTick);
  const std::size_t before = allocations::count();
  for (int k = 0; k < 100; ++k) drive.path.update(drive.q, post, kPathTick);
  EXPECT_EQ(allocations::count(), before);
}

}  // namespace
