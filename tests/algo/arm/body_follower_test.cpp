// tests/algo/arm/body_follower_test.cpp: a body that drives along its strip past things that move.
#include "algo/arm/body_follower.hpp"

#include "tests/algo/allocations.hpp"
#include "tests/algo/arm/carried_arm.hpp"
#include <gtest/gtest.h>

namespace {

using algo::BodyCommand;
using algo::BodyFollower;
using algo::BodyJoints;
using algo::FollowState;
using algo::MobileArm;
using algo::Solid;

constexpr double kReach = 0.70;
constexpr double kArmTick = 0.05;  // [s]

Solid arm_post(double x, double y, const algo::Vec2& velocity_W = algo::Vec2::Zero()) {
  Solid solid = carried_arm::post_before_arm(kReach, 0);
  solid.centre_W = {x, y};
  solid.velocity_W = velocity_W;
  return solid;
}

struct BodyDrive {
  bool arrived = false;
  double seconds = 0;
  double clearance = 1e9;  // [m]
  BodyJoints end = BodyJoints::Zero();
};

BodyDrive drive_body(BodyFollower& follower,
                     BodyJoints q,
                     std::vector<Solid> solids,
                     double longest = 30) {
  const MobileArm body;
  BodyDrive result;
  for (; result.seconds < longest; result.seconds += kArmTick) {
    std::vector<Solid> seen = solids;
    keep_ahead_free(seen);
    const BodyCommand command = follower.update(q, seen, kArmTick);
    EXPECT_LE(std::abs(command.base.v), algo::BodyLimits{}.max_v);
    EXPECT_LE(std::abs(command.base.omega), algo::BodyLimits{}.max_omega);
    EXPECT_LE(command.rates.cwiseAbs().maxCoeff(), algo::BodyLimits{}.max_rate + 1e-9);
    if (command.state == FollowState::Arrived) {
      result.arrived = true;
      break;
    }
    q = moved(q, command, kArmTick);
    EXPECT_GE(limit_margin(body.arm, algo::arm_of(q)), 0);
    for (Solid& solid : solids) solid = solid.after(kArmTick);
    result.clearance =
        std::min(result.clearance, clearance(body, body_frames(body, q), solids).smallest());
  }
  result.end = q;
  return result;
}

BodyDrive carried_past(const std::vector<Solid>& solids) {
  const auto path = carried_arm::straight_path(kReach);
  BodyFollower follower(MobileArm{}, {});
  follower.begin(path);
  return drive_body(follower, path.front(), solids);
}

TEST(BodyFollower, GoesToItsGoalWhenNothingIsNear) {
  const BodyDrive free = carried_past({});
  EXPECT_TRUE(free.arrived);
  EXPECT_LT((free.end - carried_arm::straight_path(kReach).back()).cwiseAbs().maxCoeff(), 0.006);
  EXPECT_LT(free.seconds, 12);
}

TEST(BodyFollower, PassesPostsThatStandComeCrossAndAreOvertaken) {
  const double y = -0.22 - kReach;
  const std::vector<std::vector<Solid>> courses{{arm_post(2, y + 0.1)},
                                                {arm_post(4, y + 0.1, {-0.3, 0})},
                                                {arm_post(1, y + 0.1, {0.3, 0})},
                                                {arm_post(2, y - 1.2, {0, 0.3})},
                                                {arm_post(3, y + 0.1, {-0.3, 0}),
                                                 arm_post(2, y - 1.0, {0, 0.2}),
                                                 arm_post(3, y - 0.6, {-0.1, 0.1})}};
  for (std::size_t k = 0; k < courses.size(); ++k) {
    const BodyDrive past = carried_past(courses[k]);
    EXPECT_TRUE(past.arrived) << "course " << k;
    EXPECT_GT(past.clearance, 0.05) << "course " << k;
  }
}

TEST(BodyFollower, WaitsBeforeAWayThatIsBlockedAndGoesOnOnceItIsFree) {
  const auto path = carried_arm::straight_path(kReach);
  BodyFollower follower(MobileArm{}, {});
  follower.begin(path);
  const BodyDrive blocked = drive_body(follower, path.front(), {arm_post(2, 0)}, 20);
  EXPECT_FALSE(blocked.arrived);
  EXPECT_GT(blocked.clearance, 0.04);
  EXPECT_TRUE(drive_body(follower, blocked.end, {}).arrived);
}

TEST(BodyFollower, GetsOutOfTheWayOfWhatWalksIntoItWhereItWaits) {
  const auto path = carried_arm::straight_path(kReach);
  const Solid bar = arm_post(1.5, 0);
  for (const double side : {-1.0, 1.0}) {
    BodyFollower follower(MobileArm{}, {});
    follower.begin(path);
    const BodyDrive waits = drive_body(follower, path.front(), {bar}, 10);
    const Solid walker = arm_post(waits.end[0], side * 2.5, {0, -side * 0.25});
    EXPECT_GT(drive_body(follower, waits.end, {bar, walker}, 20).clearance, 0.02) << side;
  }
}

TEST(BodyFollower, MovesTheArmAloneWhereTheBaseStands) {
  const BodyJoints from = carried_arm::stretched_aside(0.70);
  const BodyJoints to = carried_arm::stretched_aside(0.55);
  std::vector<BodyJoints> path;
  for (int i = 0; i <= 10; ++i) path.push_back(from + (to - from) * i / 10.0);
  BodyFollower follower(MobileArm{}, {});
  follower.begin(path);
  const BodyDrive there = drive_body(follower, from, {});
  EXPECT_TRUE(there.arrived);
  EXPECT_LT((there.end - to).cwiseAbs().maxCoeff(), 0.006);
}

TEST(BodyFollower, TheArmDrawsBackAtItsGoalFromWhatComes) {
  const auto path = carried_arm::straight_path(kReach);
  BodyFollower follower(MobileArm{}, {});
  follower.begin(path);
  const MobileArm body;
  BodyJoints q = path.back();
  std::vector<Solid> solids{arm_post(q[0] - 1.5, -0.22 - kReach + 0.1, {0.3, 0})};
  double least = 1e9;
  for (double time = 0; time < 8; time += kArmTick) {
    q = moved(q, follower.update(q, solids, kArmTick), kArmTick);
    for (Solid& solid : solids) solid = solid.after(kArmTick);
    least = std::min(least, clearance(body, body_frames(body, q), solids).smallest());
  }
  EXPECT_GT(least, 0.05);
}

TEST(BodyFollower, ATickAllocatesNothing) {
  const auto path = carried_arm::straight_path(kReach);
  BodyFollower follower(MobileArm{}, {});
  follower.begin(path);
  const std::array solids{arm_post(2, -0.9)};
  BodyJoints q = path.front();
  const auto before = allocations::count();
  for (int n = 0; n < 60; ++n) q = moved(q, follower.update(q, solids, kArmTick), kArmTick);
  EXPECT_EQ(allocations::count(), before);
  EXPECT_LT(follower.strip().size(), path.size());
}

}  // namespace
