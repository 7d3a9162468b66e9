// tests/algo/pipeline/shared_control_test.cpp: the modes of the stick, through the whole pipeline.
#include "algo/pipeline/shared_control.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "tests/algo/allocations.hpp"
#include "tests/algo/pipeline/by_hand.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "algo/teleop/teleop_parameters.hpp"

namespace {

using algo::Joystick;
using algo::StickMode;
using by_hand::box;
using by_hand::ByHand;

constexpr Joystick kAhead{1, 0, StickMode::Wall};

/// A wall along x, its face `beside` [m] to the left of the start; negative: to the right.
ByHand beside_wall(double beside) {
  ByHand robot;
  const double far = beside + std::copysign(0.2, beside);
  robot.world.polygons.push_back(box({-5, std::min(beside, far)}, {30, std::max(beside, far)}));
  robot.start();
  return robot;
}

double value(const ByHand& robot, const char* name) {
  return robot.t.output.measure(name).value_or(-99);
}

TEST(SharedControl, KeepsTheDistanceToAWallOnEitherSide) {
  for (const double beside : {1.2, -1.2, 0.6, -0.6}) {
    ByHand robot = beside_wall(beside);
    robot.hold(kAhead, 20);
    SCOPED_TRACE(beside);
    // The model's cells are 10 cm and 5 degrees wide.
    EXPECT_NEAR(std::abs(beside - robot.pose.y), 0.8, 0.12);
    EXPECT_NEAR(robot.pose.heading, 0, 0.15);
    EXPECT_GT(robot.pose.x, 0.8);
    EXPECT_GT(robot.least, 0.05);
  }
}

TEST(SharedControl, FollowsNoWallUnlessTheStickIsNearlyFull) {
  ByHand robot = beside_wall(-1.2);
  robot.hold({0.85, 0, StickMode::Wall}, 6);
  EXPECT_NEAR(robot.pose.y, 0, 1e-6);
  EXPECT_TRUE(std::isnan(value(robot, "teleop.w_d")));
}

TEST(SharedControl, StopsByDegreesBeforeAnObstacleAndSaysWhy) {
  ByHand robot;
  robot.world.circles.push_back({{3, 0}, 0.15});
  robot.start();
  robot.hold({0.8, 0, StickMode::Wall}, 40);
  EXPECT_EQ(robot.t.limit, algo::limits::kAhead);
  EXPECT_LT(robot.twist.v, 0.01);
  EXPECT_GT(robot.least, 3 - 0.15 - 0.35 - robot.pose.x - 1e-9);
  EXPECT_NEAR(3 - 0.15 - robot.pose.x, 0.5, 0.12) << "D_min from the centre";
}

TEST(SharedControl, LeavesTheStickAloneInTheOpen) {
  ByHand robot;
  robot.start();
  robot.hold({0.8, 0.3, StickMode::Wall}, 3);
  EXPECT_DOUBLE_EQ(robot.t.command.base.v, 0.8 * 0.5 * (1 - std::exp(-3 * (3 - 0.5))));
  EXPECT_DOUBLE_EQ(robot.t.command.base.omega, 0.3);
  EXPECT_EQ(value(robot, "teleop.force_left"), 0);
  EXPECT_FALSE(robot.t.limit);
}

TEST(SharedControl, TheSparsenessShrinksEveryTenthOfASecondAtAnyPeriod) {
  for (const double period : {0.02, 0.025, 0.026, 0.05, 0.1}) {
    ByHand robot;
    robot.spec.period = period;
    robot.world.circles.push_back({{0, 0.9}, 0.1});
    robot.start();
    SCOPED_TRACE(period);
    robot.hold({0, 0.01, StickMode::Wall}, 1.05);
    EXPECT_NEAR(value(robot, "teleop.v_sprs"), 0.5 * std::pow(0.9, 10), 1e-3);
  }
}

TEST(SharedControl, PushesTheHandBackFromAnObstacleAndTowardsTheWallsTurn) {
  ByHand near;
  near.world.circles.push_back({{1.2, 0}, 0.15});
  near.start();
  near.hold({0.8, 0, StickMode::Wall}, 1);
  EXPECT_LT(value(near, "teleop.force_forward"), 0);
  ByHand right = beside_wall(-1.2);
  right.hold(kAhead, 1);
  EXPECT_LT(value(right, "teleop.w_d"), 0) << "too far from it: turn right";
  EXPECT_LT(value(right, "teleop.force_left"), 0);
}

TEST(SharedControl, StartsAfreshWhenTheStickIsTakenAnew) {
  ByHand robot;
  robot.world.circles.push_back({{0, 0.9}, 0.1});
  robot.start();
  robot.hold({0, 0.01, StickMode::Wall}, 2);
  robot.idle(1);
  robot.hold({0, 0.01, StickMode::Wall}, 0.05);
  EXPECT_DOUBLE_EQ(value(robot, "teleop.v_sprs"), 0.5);
}

TEST(SharedControl, ASonarThatFailsCountsAsAnObstacle) {
  ByHand robot;
  robot.spec.has_laser = false;
  robot.scans = false;
  for (const double bearing : algo::ring_bearings()) robot.sonars.push_back(bearing);
  robot.start();
  robot.hold({0.8, 0, StickMode::Wall}, 1);
  ASSERT_EQ(robot.t.observation.sonar.size(), 8U);
  EXPECT_GT(value(robot, "teleop.nearest"), 2.9);
  robot.sonars.clear();
  robot.hold({0.8, 0, StickMode::Wall}, 1);
  EXPECT_EQ(robot.twist.v, 0);
}

/// A robot beside a wall, with a laser and a ring of its own.
ByHand with_ring(double beside) {
  ByHand robot = beside_wall(beside);
  robot.spec.has_ring = true;
  for (const double bearing : algo::ring_bearings()) robot.sonars.push_back(bearing);
  robot.start();
  return robot;
}

/// The first and last axis look straight to the sides; the hull's circle is 0.35 m.
TEST(SharedControl, ARobotWithARingOfItsOwnIsHeardByIt) {
  ByHand robot = with_ring(1.2);
  robot.hold({0.5, 0, StickMode::Wall}, 0.5);
  EXPECT_NEAR(value(robot, "teleop.nearest"), 1.2, 1e-9);
  robot.sonars.clear();
  robot.hold({0.5, 0, StickMode::Wall}, 0.5);
  EXPECT_EQ(robot.t.command.base.v, 0) << "a ring that fails must not open the way";
  robot.spec.has_ring = false;
  robot.start();
  robot.hold({0.5, 0, StickMode::Wall}, 0.5);
  EXPECT_GT(robot.t.command.base.v, 0) << "by virtual sonars";
}

/// The ring is heard in every mode, so the first tick of mode wall knows the wall.
TEST(SharedControl, TheRingIsKnownFromTheFirstTick) {
  ByHand robot = with_ring(1.2);
  robot.hold({0.1, 0, StickMode::Guarded}, 0.5);
  robot.tick({0.1, 0, StickMode::Wall});
  EXPECT_NEAR(value(robot, "teleop.nearest"), 1.2, 1e-9);
}

void set(ByHand& robot, const algo::ParameterInfo& parameter, double to) {
  robot.sense();
  robot.t.requests.clear();
  robot.t.requests.push_back(algo::SetParameter{&parameter, to});
  robot.pipeline->tick(robot.t);
}

TEST(SharedControl, ShowsTheBandsOfBothAxes) {
  ByHand robot = beside_wall(1.2);
  robot.hold(kAhead, 1);
  const double w_d = value(robot, "teleop.w_d");
  EXPECT_GT(w_d, 0);
  EXPECT_DOUBLE_EQ(value(robot, "teleop.q_offset_left"), w_d);  // w_max is 1
  EXPECT_DOUBLE_EQ(value(robot, "teleop.dead_band_left"), 0.01);
  robot.hold({0.8, 0, StickMode::Wall}, 0.1);
  EXPECT_EQ(value(robot, "teleop.q_offset_left"), 0);
  EXPECT_EQ(value(robot, "teleop.dead_band_left"), 1);
}

/// The wall 1.2 m beside leaves 1 - exp(-3 (1.2 - 0.5)) of the smaller of v and v_sprs.
TEST(SharedControl, TheForwardForceHasThreeReadings) {
  const double slowed = 1 - std::exp(-3 * 0.7);
  for (const auto& [reading, of_v_sprs] :
       {std::pair{0.0, slowed}, std::pair{1.0, 1.0}, std::pair{2.0, 0.0}}) {
    ByHand robot = beside_wall(1.2);
    set(robot, algo::kForwardForce, reading);
    robot.hold({0.1, 0, StickMode::Wall}, 1);
    const double v_sprs = value(robot, "teleop.v_sprs") / 0.5;
    const double expected = reading == 2 ? 0.1 * slowed : v_sprs * of_v_sprs;
    EXPECT_NEAR(value(robot, "teleop.q_offset_forward"), expected, 2e-3) << reading;
  }
}

/// Farther than D_ref on the right the printed factor of xi_2 is 1 + x, the corrected one 1 - x;
/// the nose points to the wall, so xi_2 turns left.
TEST(SharedControl, TheWallLawHasTheLiteralReading) {
  const auto turn_at = [](double law) {
    ByHand robot = beside_wall(-1.2);
    robot.pose.heading = -0.3;
    set(robot, algo::kWallLaw, law);
    robot.hold(kAhead, 0.3);
    return value(robot, "teleop.w_d");
  };
  EXPECT_GT(turn_at(1), turn_at(0) + 0.2);
}

/// As printed, the followed wall is the newest; ours waits half a second on the other side.
TEST(SharedControl, ThePatienceWithSidesIsOursAlone) {
  for (const double law : {0.0, 1.0}) {
    ByHand robot = beside_wall(1.2);
    set(robot, algo::kWallLaw, law);
    robot.hold({0.5, 0, StickMode::Wall}, 1);
    ASSERT_GT(value(robot, "teleop.wall_theta"), 0);
    robot.world.polygons.clear();
    robot.world.polygons.push_back(box({-5, -1.4}, {30, -1.2}));
    robot.hold({0.5, 0, StickMode::Wall}, 0.2);
    EXPECT_LT(value(robot, "teleop.seen_theta"), 0);
    EXPECT_EQ(value(robot, "teleop.wall_theta") < 0, law == 1) << law;
  }
}

TEST(StickModes, TheGuardSaysThatItLimits) {
  ByHand robot;
  robot.world.polygons.push_back(box({2, -3}, {2.2, 3}));
  robot.start();
  robot.hold({1, 0}, 1);
  EXPECT_FALSE(robot.t.limit);
  robot.hold({1, 0}, 8);
  EXPECT_EQ(robot.t.limit, algo::limits::kGuard);
}

TEST(StickModes, RawObeysTheStickWhereTheRobotAllowsIt) {
  ByHand robot;
  robot.world.polygons.push_back(box({1, -3}, {1.2, 3}));
  robot.start();
  const Joystick raw{1, 0, StickMode::Raw};
  EXPECT_THAT(robot.pipeline->refusal(raw).value_or(""), testing::HasSubstr("raw"));
  robot.spec.raw_stick = true;
  robot.start();
  EXPECT_FALSE(robot.pipeline->refusal(raw));
  robot.hold(raw, 4);
  EXPECT_LT(robot.least, 0);
  EXPECT_EQ(robot.t.command.base.v, 0.5);
  EXPECT_FALSE(robot.t.limit);
}

TEST(StickModes, WallIsRefusedWithAStopDistanceWithinTheHull) {
  ByHand robot;
  robot.spec.radius = 0.6;
  robot.start();
  EXPECT_THAT(robot.pipeline->refusal(kAhead).value_or(""), testing::HasSubstr("teleop.d_min"));
  EXPECT_FALSE(robot.pipeline->refusal(Joystick{1, 0}));
}

TEST(StickModes, FullStickAsksForNoMoreThanTheParameter) {
  ByHand robot;
  robot.start();
  robot.t.requests.clear();
  robot.sense();
  robot.t.requests.push_back(algo::SetParameter{&algo::kStickSpeed, 0.2});
  robot.pipeline->tick(robot.t);
  robot.hold({1, 0}, 1);
  EXPECT_EQ(robot.t.command.base.v, 0.2);
}

/// A link with this round trip [s].
Joystick over_link(double round_trip, StickMode mode = StickMode::Guarded) {
  return {1, 0, mode, round_trip};
}

/// [m/s] at this distance [m] ahead of a wall, with the stick fully ahead.
double speed_before_wall(double distance, const Joystick& stick) {
  ByHand robot;
  robot.world.polygons.push_back(box({distance, -3}, {distance + 0.2, 3}));
  robot.start();
  robot.hold(stick, 1);
  return robot.t.command.base.v;
}

TEST(StickModes, ASlowLinkKeepsMoreRoom) {
  // 0.5 m/s covers in a round trip of 0.45 s and a reaction 0.28 m, and brakes in 0.25 m more.
  EXPECT_EQ(speed_before_wall(1.6, over_link(0)), 0.5);
  EXPECT_EQ(speed_before_wall(1.6, over_link(0.45)), 0.5);
  EXPECT_EQ(speed_before_wall(1.2, over_link(0)), 0.5);
  const double far = speed_before_wall(1.2, over_link(0.45));
  const double farther = speed_before_wall(1.2, over_link(0.3));
  EXPECT_LT(far, farther);
  EXPECT_LT(far, 0.5);
  EXPECT_GT(far, 0);
}

TEST(StickModes, TheLinkIsNamedWhereItLimits) {
  ByHand robot;
  robot.world.polygons.push_back(box({1.2, -3}, {1.4, 3}));
  robot.start();
  robot.hold(over_link(0.45), 1);
  EXPECT_EQ(robot.t.limit, algo::limits::kLink);
  robot.hold(over_link(0.45), 6);
  EXPECT_GT(robot.least, 0);
}

TEST(StickModes, OverATooSlowLinkOnlyTheMiddleCounts) {
  ByHand robot;
  robot.start();
  EXPECT_FALSE(robot.pipeline->refusal(over_link(0.5)));
  EXPECT_THAT(robot.pipeline->refusal(over_link(0.51)).value_or(""), testing::HasSubstr("Stop"));
  EXPECT_FALSE(robot.pipeline->refusal(Joystick{0, 0, StickMode::Guarded, 3}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(robot.pipeline->refusal(over_link(nan)));
  EXPECT_TRUE(robot.pipeline->refusal(over_link(-1)));
}

TEST(StickModes, RawIsSlowedByTheRoundTripAlone) {
  ByHand robot;
  robot.spec.raw_stick = true;
  robot.spec.max_v = 2;
  robot.start();
  robot.hold(over_link(0, StickMode::Raw), 0.1);
  EXPECT_EQ(robot.t.command.base.v, 2);
  robot.hold(over_link(0.4, StickMode::Raw), 0.1);
  EXPECT_NEAR(robot.t.command.base.v, 0.3 / 0.5, 1e-12);
  EXPECT_EQ(robot.t.limit, algo::limits::kLink);
}

TEST(StickModes, ElasticFindsItsWayRoundAnObstacle) {
  // GIVEN a pillar on the line WHEN the stick is pushed straight ahead THEN guarded stops before
  // it, and elastic passes.
  for (const StickMode mode : {StickMode::Guarded, StickMode::Elastic}) {
    ByHand robot;
    robot.world.circles.push_back({{2, 0.1}, 0.3});
    robot.start();
    robot.hold({1, 0, mode}, 16);
    EXPECT_GT(robot.least, 0) << name(mode);
    if (mode == StickMode::Guarded) {
      EXPECT_LT(robot.pose.x, 1.5);
    } else {
      EXPECT_GT(robot.pose.x, 2.7);
      EXPECT_EQ(robot.t.behaviour, algo::behaviours::kManual);
    }
  }
}

TEST(StickModes, ElasticIsNoFasterThanTheStickAsks) {
  ByHand robot;
  robot.start();
  robot.hold({0.4, 0, StickMode::Elastic}, 3);
  EXPECT_NEAR(robot.t.command.base.v, 0.2, 0.02);
  EXPECT_EQ(robot.t.limit, algo::limits::kPulled);
  // Back and aside, no goal is pulled along: it is guarded.
  robot.hold({0, 0.5, StickMode::Elastic}, 1);
  EXPECT_EQ(robot.t.command.base.v, 0);
  EXPECT_EQ(robot.t.command.base.omega, 0.5);
}

TEST(StickModes, ASteadyTickAllocatesNothingInAnyMode) {
  for (const StickMode mode :
       {StickMode::Guarded, StickMode::Wall, StickMode::Raw, StickMode::Elastic}) {
    ByHand robot = beside_wall(-1.0);
    robot.hold({1, 0.1, mode}, 3);
    robot.sense();
    const std::size_t before = allocations::count();
    robot.pipeline->tick(robot.t);
    EXPECT_EQ(allocations::count(), before) << name(mode);
  }
}

}  // namespace
