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
constexpr double kTick = 0.05;  // [s]

Solid post(double x, double y, const algo::Vec2& velocity_W = algo::Vec2::Zero()) {
  Solid solid = carried_arm::post_before_arm(kReach, 0);
  solid.centre_W = {x, y};
  solid.velocity_W = velocity_W;
  return solid;
}

struct Drive {
  bool arrived = false;
  double seconds = 0;
  double clearance = 1e9;  // [m]
  BodyJoints end = BodyJoints::Zero();
};

Drive drive(BodyFollower& follower, BodyJoints q, std::vector<Solid> solids, double longest = 30) {
  const MobileArm body;
  Drive result;
  for (; result.seconds < longest; result.seconds += kTick) {
    const BodyCommand command = follower.update(q, solids, kTick);
    EXPECT_LE(std::abs(command.base.v), algo::BodyLimits{}.max_v);
    EXPECT_LE(std::abs(command.base.omega), algo::BodyLimits{}.max_omega);
    EXPECT_LE(command.rates.cwiseAbs().maxCoeff(), algo::BodyLimits{}.max_rate + 1e-9);
    if (command.state == FollowState::Arrived) {
      result.arrived = true;
      break;
    }
    q = moved(q, command, kTick);
    EXPECT_GE(limit_margin(body.arm, algo::arm_of(q)), 0);
    for (Solid& solid : solids) solid = solid.after(kTick);
    result.clearance =
        std::min(result.clearance, clearance(body, body_frames(body, q), solids).smallest());
  }
  result.end = q;
  return result;
}

Drive carried_past(const std::vector<Solid>& solids) {
  const auto path = carried_arm::straight_path(kReach);
  BodyFollower follower(MobileArm{}, {});
  follower.begin(path);
  return drive(follower, path.front(), solids);
}

TEST(BodyFollower, GoesToItsGoalWhenNothingIsNear) {
  const Drive free = carried_past({});
  EXPECT_TRUE(free.arrived);
  EXPECT_LT((free.end - carried_arm::straight_path(kReach).back()).cwiseAbs().maxCoeff(), 0.006);
  EXPECT_LT(free.seconds, 12);
}

TEST(BodyFollower, PassesPostsThatStandComeCrossAndAreOvertaken) {
  const double y = -0.22 - kReach;
  const std::vector<std::vector<Solid>> courses{
      {post(2, y + 0.1)},
      {post(4, y + 0.1, {-0.3, 0})},
      {post(1, y + 0.1, {0.3, 0})},
      {post(2, y - 1.2, {0, 0.3})},
      {post(3, y + 0.1, {-0.3, 0}), post(2, y - 1.0, {0, 0.2}), post(3, y - 0.6, {-0.1, 0.1})}};
  for (std::size_t k = 0; k < courses.size(); ++k) {
    const Drive past = carried_past(courses[k]);
    EXPECT_TRUE(past.arrived) << "course " << k;
    EXPECT_GT(past.clearance, 0.05) << "course " << k;
  }
}

TEST(BodyFollower, WaitsBeforeAWayThatIsBlockedAndGoesOnOnceItIsFree) {
  const auto path = carried_arm::straight_path(kReach);
  BodyFollower follower(MobileArm{}, {});
  follower.begin(path);
  const Drive blocked = drive(follower, path.front(), {post(2, 0)}, 20);
  EXPECT_FALSE(blocked.arrived);
  EXPECT_GT(blocked.clearance, 0.04);
  EXPECT_TRUE(drive(follower, blocked.end, {}).arrived);
}

TEST(BodyFollower, MovesTheArmAloneWhereTheBaseStands) {
  const BodyJoints from = carried_arm::stretched_aside(0.70);
  const BodyJoints to = carried_arm::stretched_aside(0.55);
  std::vector<BodyJoints> path;
  for (int i = 0; i <= 10; ++i) path.push_back(from + (to - from) * i / 10.0);
  BodyFollower follower(MobileArm{}, {});
  follower.begin(path);
  const Drive there = drive(follower, from, {});
  EXPECT_TRUE(there.arrived);
  EXPECT_LT((there.end - to).cwiseAbs().maxCoeff(), 0.006);
}

TEST(BodyFollower, TheArmDrawsBackAtItsGoalFromWhatComes) {
  const auto path = carried_arm::straight_path(kReach);
  BodyFollower follower(MobileArm{}, {});
  follower.begin(path);
  const MobileArm body;
  BodyJoints q = path.back();
  std::vector<Solid> solids{post(q[0] - 1.5, -0.22 - kReach + 0.1, {0.3, 0})};
  double least = 1e9;
  for (double time = 0; time < 8; time += kTick) {
    q = moved(q, follower.update(q, solids, kTick), kTick);
    for (Solid& solid : solids) solid = solid.after(kTick);
    least = std::min(least, clearance(body, body_frames(body, q), solids).smallest());
  }
  EXPECT_GT(least, 0.05);
}

TEST(BodyFollower, ATickAllocatesNothing) {
  const auto path = carried_arm::straight_path(kReach);
  BodyFollower follower(MobileArm{}, {});
  follower.begin(path);
  const std::array solids{post(2, -0.9)};
  BodyJoints q = path.front();
  const auto before = allocations::count();
  for (int n = 0; n < 60; ++n) q = moved(q, follower.update(q, solids, kTick), kTick);
  EXPECT_EQ(allocations::count(), before);
  EXPECT_LT(follower.strip().size(), path.size());
}

}  // namespace
