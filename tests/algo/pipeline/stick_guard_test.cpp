// tests/algo/pipeline/stick_guard_test.cpp: where the robot stops while the stick is held at full
// deflection.
#include "algo/pipeline/stick_guard.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/algo/allocations.hpp"
#include "tests/algo/pipeline/by_hand.hpp"
#include <gtest/gtest.h>

#include "algo/pipeline/reactive.hpp"

namespace {

using algo::Joystick;
using algo::Pose2;
using algo::Vec2;
using by_hand::box;
using by_hand::ByHand;

TEST(StickGuard, KnowsTheNewestScanWhenSomebodyTakesTheStick) {
  ByHand robot;
  robot.start();
  robot.idle(0.05);  // looks at an empty world
  robot.world.polygons.push_back(box({0.42, -1}, {0.6, 1}));
  robot.idle(0.1);      // too soon for a second look
  robot.scans = false;  // nothing new comes after that
  robot.hold({.forward = 1}, 0.5);
  EXPECT_GE(robot.least, 0.05 - 1e-6);
  EXPECT_LE(robot.pose.x, 0.02 + 1e-6);
  ByHand ignorant;  // it would have gone on
  ignorant.start();
  ignorant.idle(0.15);
  ignorant.scans = false;
  ignorant.hold({.forward = 1}, 0.5);
  EXPECT_GT(ignorant.pose.x, 0.02);
}

TEST(StickGuard, StopsAheadForAnyDelayAndBaseResponse) {
  for (const bool rectangle : {false, true}) {
    for (const unsigned delay : {0U, 4U}) {
      for (const bool at_once : {false, true}) {
        for (const double turn : {0.0, 0.3, -1.0}) {
          ByHand robot(rectangle, delay, at_once);
          robot.world.polygons.push_back(box({2, -3}, {2.2, 3}));
          robot.start();
          robot.hold({1, 0}, 0.5);
          robot.hold({1, turn}, 8);
          EXPECT_GT(robot.least, 0.03) << rectangle << delay << at_once << turn;
          if (turn == 0) {
            EXPECT_LT(robot.least, 0.12) << rectangle << delay << at_once;
          }
        }
      }
    }
  }
}

/// Passed obstacles are out of sight, and the corners reach farther out than the sides.
TEST(StickGuard, ARectangleDoesNotTurnIntoAPassedObstacle) {
  for (const double turn : {1.0, -1.0}) {
    ByHand robot(true);
    robot.pose = {-1.5, 0, 0};
    robot.world.polygons.push_back(box({-0.6, 0.29}, {-0.1, 0.6}));
    robot.world.polygons.push_back(box({-0.6, -0.6}, {-0.1, -0.29}));
    robot.start();
    while (robot.pose.x < 0 && robot.stamp < 20) robot.tick({0.2, 0});
    robot.hold({0, 0}, 0.5);
    ASSERT_GT(robot.pose.x, -0.05);
    robot.least = 10;
    robot.hold({0, turn}, 4);
    EXPECT_GT(robot.least, 0.02);
  }
}

TEST(StickGuard, BacksSlowlyWithoutARearSensor) {
  ByHand robot;
  robot.start();
  robot.hold({1, 0}, 4);
  robot.hold({0, 0}, 2);
  const double there = robot.pose.x;
  ASSERT_GT(there, 1);
  robot.hold({-1, 0}, 4);  // where it has come from, so at once
  EXPECT_LE(robot.fastest_back, 0.1 + 1e-9);
  EXPECT_NEAR(there - robot.pose.x, 0.39, 0.03);
}

/// At the start the space behind is unknown.
TEST(StickGuard, NeverBacksIntoUnseenSpace) {
  ByHand robot;
  robot.start();
  robot.hold({-1, 0}, 10);
  EXPECT_EQ(robot.pose.x, 0);
  robot.hold({1, 0}, 3);
  robot.hold({0, 0}, 2);
  ASSERT_GT(robot.pose.x, 1);
  robot.hold({-1, 0}, 30);  // as far as it has seen and stood, and no farther
  EXPECT_LT(robot.pose.x, 0.3);
  EXPECT_GT(robot.pose.x, -0.05);
  EXPECT_LE(robot.fastest_back, 0.1 + 1e-9);
}

/// It has seen the wall beside it. Then somebody turns it by a third of a turn, and its odometry
/// does not tell: the wall lies behind now, where no scanner looks.
TEST(StickGuard, AfterAShoveItDoesNotBackIntoSomethingItKnewElsewhere) {
  ByHand robot;
  robot.world.polygons.push_back(box({-4, -4}, {9, 4}));
  robot.world.polygons.push_back(box({-2, 0.45}, {3, 0.6}));
  robot.start();
  robot.hold({0.5, 0}, 4);
  robot.hold({0, 0}, 1.5);
  for (int k = 0; k < 12; ++k) {
    robot.pose.heading -= 0.15;
    robot.tick({0, 0});
  }
  robot.hold({0, 0}, 1);
  ASSERT_GT(robot.clearance(), 0.05);
  robot.least = 10;
  robot.hold({-1, 0}, 6);
  EXPECT_GT(robot.least, 0.03);
}

/// Drives towards a wall while a person comes: the first circle of the world, at `velocity_W`.
struct Encounter {
  explicit Encounter(const Vec2& from_W, const Vec2& velocity, bool rectangle = false)
      : robot(rectangle), velocity_W(velocity) {
    robot.world.circles.push_back({from_W, 0.25});
    robot.world.polygons.push_back(box({-4, -4}, {9, 4}));
    robot.start();
  }
  void hold(const Joystick& stick, double seconds) {
    const double end = robot.stamp + seconds;
    while (robot.stamp < end - 1e-9) {
      const Vec2 before = robot.pose.position();
      robot.tick(stick);
      Vec2& person = robot.world.circles[0].centre;
      const Vec2 way = (person - before).normalized();
      const double towards = (robot.pose.position() - before).dot(way) / robot.spec.period;
      const double far = (person - robot.pose.position()).norm() - 0.25 - robot.spec.radius;
      least = std::min(least, far);
      if (towards > 0.05 && least > 0) least_moving = std::min(least_moving, far);
      person += robot.spec.period * velocity_W;
    }
  }
  ByHand robot;
  Vec2 velocity_W{0, 0};
  double least = 10;         // [m] to the person
  double least_moving = 10;  // [m] the same while the robot moves towards them, until they meet
};

TEST(StickGuard, BrakesEarlierForAPersonWhoComes) {
  for (const bool rectangle : {false, true}) {
    Encounter standing({6, 0}, {0, 0}, rectangle);
    standing.hold({1, 0}, 20);
    EXPECT_LT(standing.least, 0.25) << "it drives up to a person who stands";
    Encounter coming({6, 0}, {-1.2, 0}, rectangle);
    coming.hold({1, 0}, 8);
    EXPECT_LT(coming.least, 0) << "the person walks through it";
    EXPECT_GT(coming.least_moving, 0.1) << "but the robot stood by then";
  }
}

TEST(StickGuard, SomebodyWhoHasStoppedMayGoOn) {
  for (const bool rectangle : {false, true}) {
    for (const double near : {1.2, 1.6, 2.0}) {
      Encounter meeting({near + 2.6, 0}, {-1.3, 0}, rectangle);
      meeting.hold({0, 0}, 2);
      meeting.velocity_W = {0, 0};
      meeting.hold({1, 0}, 1.2);
      meeting.velocity_W = {-1.3, 0};
      meeting.hold({1, 0}, 3);
      EXPECT_GT(meeting.least_moving, 0.05) << rectangle << " " << near;
      EXPECT_GT(meeting.robot.pose.x, 0.1) << rectangle << " " << near;
    }
  }
}

TEST(StickGuard, MayStandTurnAndBackAwayWhileAPersonComes) {
  Encounter meeting({5, 0}, {-0.6, 0});
  meeting.hold({1, 0}, 2.5);
  meeting.hold({0, 0}, 1.0);
  meeting.hold({0, 1}, 0.5);
  const double heading = meeting.robot.pose.heading;
  EXPECT_GT(heading, 0.2) << "a disc may turn";
  const double there = meeting.robot.pose.x;
  meeting.hold({-1, 0}, 1.0);
  EXPECT_LT(meeting.robot.pose.x, there - 0.03) << "and back away to where it came from";
}

/// Someone walks across in front and away: what they leave is no wall.
TEST(StickGuard, APersonWhoHasPassedLeavesNoWall) {
  Encounter meeting({1.5, -3}, {0, 1.0});
  meeting.hold({0, 0.01}, 6);
  meeting.robot.least = 10;
  meeting.hold({1, 0}, 6);
  EXPECT_GT(meeting.robot.pose.x, 2);
}

/// A guard with its inputs, without a pipeline.
struct Lone {
  explicit Lone(bool rectangle) : body(rectangle) {
    in.spec = &body.spec;
    in.observation = &body.t.observation;
    in.scene = &scene;
    in.merge = &merge;
    in.parameters = &parameters;
    in.dt = body.spec.period;
    in.manual = true;
    body.rear_scanner = false;
  }
  void look() {
    body.sense();
    in.stamp = body.stamp;
    in.odometry = body.t.observation.odometry;
    scene.scan = body.t.observation.scans[0];
    guard.sense(in);
    body.stamp += body.spec.period;
  }
  ByHand body;
  algo::Scene scene{};
  algo::SensorMerge merge{};
  algo::Parameters parameters{};
  algo::Resource in{};
  algo::StickGuard guard{};
};

TEST(StickGuard, AdmissibleCommandsPassUnchangedAndHardlyAnyIsNearerThanItsAnswer) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  int passed = 0;
  int changed = 0;
  int moved = 0;
  for (int trial = 0; trial < 120; ++trial) {
    Lone lone(trial % 2 == 0);
    for (int k = 0; k < 6; ++k) {
      const Vec2 at(2 * unit(random), 2 * unit(random));
      const double size = 0.15 + 0.1 * unit(random);
      if (at.norm() < 0.45 + 1.5 * size) continue;
      lone.body.world.polygons.push_back(box(at - Vec2(size, size), at + Vec2(size, size)));
    }
    const algo::RobotSpec& spec = lone.body.spec;
    lone.guard.reset(lone.body.pose);
    for (int k = 0; k < 4; ++k) lone.look();
    lone.body.twist = {std::max(0.0, 0.3 * unit(random)) * spec.max_v, 0.2 * unit(random)};
    lone.look();
    for (int k = 0; k < 5; ++k) {
      const algo::Twist2 wanted{unit(random) * spec.max_v, unit(random) * spec.max_omega};
      const algo::Twist2 found = lone.guard.limit(lone.in, wanted);
      if (lone.guard.admits(lone.in, wanted)) {
        EXPECT_EQ(found, wanted);
        ++passed;
        continue;
      }
      ++changed;
      moved += found == algo::Twist2{} ? 0 : 1;
      EXPECT_TRUE(lone.guard.admits(lone.in, found));
      EXPECT_EQ(found, lone.guard.limit(lone.in, wanted)) << "the same again";
      EXPECT_GE(found.v * wanted.v, 0);
      EXPECT_GE(found.omega * wanted.omega, 0);
      EXPECT_LE(std::abs(found.v), std::abs(wanted.v));
      EXPECT_LE(std::abs(found.omega), std::abs(wanted.omega));
      const auto far = [&](const algo::Twist2& t) {
        return std::hypot((t.v - wanted.v) / spec.max_v, (t.omega - wanted.omega) / spec.max_omega);
      };
      double least = far({});
      constexpr int kCoarse = 4;
      for (int i = 0; i <= kCoarse; ++i) {
        for (int j = 0; j <= kCoarse; ++j) {
          const algo::Twist2 t{wanted.v * i / kCoarse, wanted.omega * j / kCoarse};
          if (far(t) < least && lone.guard.admits(lone.in, t)) least = far(t);
        }
      }
      EXPECT_LE(far(found), least + 0.06) << trial;
    }
  }
  EXPECT_GT(passed, 50);
  EXPECT_GT(changed, 50);
  EXPECT_GT(moved, 30);
}

TEST(StickGuard, ARearScannerLetsItBackFastAndStopsIt) {
  ByHand robot;
  robot.rear_scanner = true;
  robot.world.polygons.push_back(box({-2.6, -3}, {-2.4, 3}));
  robot.start();
  robot.hold({-1, 0}, 8);
  EXPECT_GT(robot.fastest_back, 0.45);
  EXPECT_GT(robot.least, 0.03);
  EXPECT_LT(robot.least, 0.12);
}

TEST(StickGuard, SonarsLetItBackFastAndStopIt) {
  ByHand robot;
  for (int k = 0; k < 12; ++k) robot.sonars.push_back(k * std::numbers::pi / 6);
  robot.world.polygons.push_back(box({-2.6, -3}, {-2.4, 3}));
  robot.start();
  robot.hold({-1, 0}, 8);
  EXPECT_GT(robot.fastest_back, 0.45);
  EXPECT_GT(robot.least, 0.16) << "a sonar reads nothing nearer than 0.15 m";
  EXPECT_LT(robot.least, 0.3);
}

TEST(StickGuard, ADriverCanLeaveATightPlace) {
  ByHand robot;
  robot.world.polygons.push_back(box({0.38, -1}, {0.6, 1}));  // 3 cm ahead of the hull
  robot.start();
  robot.hold({0, 1}, std::numbers::pi);
  EXPECT_NEAR(std::abs(robot.pose.heading), std::numbers::pi, 0.3);
  robot.hold({1, 0}, 3);
  EXPECT_LT(robot.pose.x, -0.5);
}

TEST(StickGuard, ASteadyTickAllocatesNothing) {
  ByHand robot;
  robot.world.polygons.push_back(box({1, -3}, {1.2, 3}));
  robot.start();
  robot.hold({0.5, 0.4}, 8);
  const auto before = allocations::count();
  robot.hold({0.5, -0.4}, 4);
  robot.hold({-1, 0.2}, 4);
  EXPECT_EQ(allocations::count(), before);
}

}  // namespace
