// tests/algo/teleop/wall_following_test.cpp: turn rates beside a wall, and the followed side.
#include "algo/teleop/wall_following.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "tests/algo/allocations.hpp"
#include "tests/algo/not_finite.hpp"
#include <gtest/gtest.h>

#include "algo/diff_drive.hpp"
#include "algo/teleop/speed_limit.hpp"

namespace {

using algo::FollowedSide;
using algo::Parameters;
using algo::WallLaw;
using algo::WallModel;
using algo::units::kRadiansPerDegree;

using tests::kNan;
constexpr double kTurn = 25 * kRadiansPerDegree;  // [rad/s] of the paper's course

WallModel wall(double rho, double degrees) {
  return {.rho = rho, .theta = degrees * kRadiansPerDegree};
}
double omega(double rho, double degrees, WallLaw law = WallLaw::Corrected) {
  return algo::follow_wall(wall(rho, degrees), kTurn, Parameters{}, law).omega;
}

/// equations.md G checks these signs.
TEST(FollowWall, TurnsTheRightWay) {
  EXPECT_GT(omega(0.8, -62.5), 0) << "nose towards a wall on the right: to the left";
  EXPECT_LT(omega(0.8, 62.5), 0) << "nose towards a wall on the left: to the right";
  EXPECT_LT(omega(1.2, -90), 0) << "too far from a wall on the right: to the right";
  EXPECT_GT(omega(1.2, 90), 0) << "too far from a wall on the left: to the left";
  EXPECT_GT(omega(0.5, -90), 0) << "too near: away";
  EXPECT_LT(omega(0.5, 90), 0);
  EXPECT_EQ(omega(0.8, -90), 0);
}

TEST(FollowWall, StraightAheadCountsAsLeft) {
  EXPECT_EQ(algo::side_of(wall(1, 0)), 1.0);
  EXPECT_EQ(algo::side_of(wall(1, -0.0)), 1.0);
  EXPECT_DOUBLE_EQ(omega(0.8, 0), -kTurn);
}

/// The corrected law treats both sides alike; the printed one does not where D_diff is not 0.
TEST(FollowWall, OnlyTheCorrectedLawIsSymmetric) {
  double asymmetry = 0;
  for (double rho = 0.05; rho < 2; rho += 0.1) {
    for (double degrees = 2.5; degrees < 180; degrees += 5) {
      EXPECT_DOUBLE_EQ(omega(rho, degrees), -omega(rho, -degrees));
      asymmetry = std::max(
          asymmetry,
          std::abs(omega(rho, degrees, WallLaw::Literal) + omega(rho, -degrees, WallLaw::Literal)));
    }
  }
  EXPECT_GT(asymmetry, kTurn);
}

TEST(FollowWall, OnlyTheCorrectedLawKeepsToTheTopTurnRate) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> far(0, 12), angle(-180, 180);
  double literal = 0;
  for (int n = 0; n < 10'000; ++n) {
    const double rho = far(random), degrees = angle(random);
    EXPECT_LE(std::abs(omega(rho, degrees)), kTurn);
    literal = std::max(literal, std::abs(omega(rho, degrees, WallLaw::Literal)));
  }
  EXPECT_GT(literal, kTurn);
}

TEST(FollowWall, NeverGivesNan) {
  for (const WallLaw law : {WallLaw::Corrected, WallLaw::Literal}) {
    for (const double bad : {kNan, std::numeric_limits<double>::infinity()}) {
      EXPECT_EQ(algo::follow_wall({.rho = bad}, kTurn, Parameters{}, law).omega, 0);
      EXPECT_EQ(algo::follow_wall({.theta = bad}, kTurn, Parameters{}, law).omega, 0);
      EXPECT_EQ(algo::follow_wall(wall(1, 1), bad, Parameters{}, law).omega, 0);
    }
  }
}

TEST(FollowsWall, NearAWallAtNearlyFullSpeed) {
  const Parameters parameters;
  EXPECT_TRUE(algo::follows_wall(wall(1.6, 80), 0.37, 0.4, parameters));
  EXPECT_FALSE(algo::follows_wall(wall(1.7, 80), 0.37, 0.4, parameters));
  EXPECT_FALSE(algo::follows_wall(wall(1.6, 80), 0.36, 0.4, parameters)) << "0.9 is not above 0.9";
  EXPECT_FALSE(algo::follows_wall(wall(1.6, 80), -0.4, 0.4, parameters));
  EXPECT_FALSE(algo::follows_wall(wall(1.6, 80), kNan, 0.4, parameters));
  EXPECT_FALSE(algo::follows_wall(wall(kNan, 80), 0.4, 0.4, parameters));
}

/// An endless wall y = -0.8 m, the true wall model, 0.36 m/s: from 35 degrees towards it and from
/// 0.4 m too far away the robot comes to D_ref and stays.
TEST(FollowWall, ClosesInOnItsDistance) {
  for (const algo::Pose2 start : {algo::Pose2{0, 0.4, 0}, algo::Pose2{0, 0.4, -0.6}}) {
    algo::Pose2 pose = start;
    for (int n = 0; n < 400; ++n) {
      const WallModel seen{.rho = pose.y + 0.8,
                           .theta = algo::wrap_angle(-std::numbers::pi / 2 - pose.heading)};
      const double w = algo::follow_wall(seen, kTurn, Parameters{}).omega;
      pose = algo::integrate_arc(pose, {0.36, w}, algo::kTeleopPeriod);
      EXPECT_GT(pose.y + 0.8, 0.39) << "the hull's corner touches the wall";
    }
    EXPECT_NEAR(pose.y, 0, 0.02);
    EXPECT_NEAR(pose.heading, 0, 0.05);
  }
}

TEST(FollowedSide, DoesNotFlickerAtAWallDeadAhead) {
  FollowedSide side;
  for (int n = 0; n < 100; ++n) {
    const WallModel seen = wall(1, n % 2 == 0 ? -2.5 : 2.5);
    const auto followed = side.follow(seen, n * 0.1);
    ASSERT_TRUE(followed);
    EXPECT_LT(followed->theta, 0) << n;
  }
}

TEST(FollowedSide, ChangesAfterHalfASecondOnTheOther) {
  FollowedSide side;
  EXPECT_LT(side.follow(wall(1, -60), 0.0)->theta, 0);
  for (int n = 1; n <= 5; ++n) {
    const auto followed = side.follow(wall(1.5, 60), n * 0.1);
    ASSERT_TRUE(followed) << n;
    EXPECT_EQ(followed->theta, wall(1, -60).theta) << "the newest wall on the followed side";
  }
  EXPECT_GT(side.follow(wall(1.5, 60), 0.6)->theta, 0);
  EXPECT_GT(side.follow(wall(1.5, -60), 0.7)->theta, 0) << "and back only after as long";
}

TEST(FollowedSide, FollowsNoStaleWall) {
  FollowedSide side;
  EXPECT_TRUE(side.follow(wall(1, -60), 0.0));
  EXPECT_FALSE(side.follow(std::nullopt, 0.1));
  EXPECT_FALSE(side.follow(std::nullopt, 0.3));
  EXPECT_TRUE(side.follow(wall(1, 60), 0.4)) << "the remembered one";
  EXPECT_FALSE(side.follow(wall(1, 60), 0.6)) << "now too old, and the other side not yet proven";
  EXPECT_GT(side.follow(wall(1, 60), 0.9)->theta, 0);
  EXPECT_FALSE(side.follow(std::nullopt, 1.0));
  EXPECT_FALSE(side.follow(std::nullopt, 1.5));
  EXPECT_LT(side.follow(wall(1, -60), 1.6)->theta, 0) << "after half a second without any wall";
}

TEST(FollowedSide, ForgetsWhenReset) {
  FollowedSide side;
  EXPECT_TRUE(side.follow(wall(1, -60), 0.0));
  side.reset();
  EXPECT_GT(side.follow(wall(1, 60), 0.1)->theta, 0);
}

TEST(FollowWall, AllocatesNothing) {
  const Parameters parameters;
  FollowedSide side;
  const auto before = allocations::count();
  const auto followed = side.follow(wall(1, -60), 0);
  EXPECT_NE(algo::follow_wall(*followed, kTurn, parameters).omega, 0);
  EXPECT_EQ(allocations::count(), before);
}

}  // namespace
