// tests/algo/pipeline/stick_guard_test.cpp: where the robot stops while the stick is held at full
// deflection.
#include "algo/pipeline/stick_guard.hpp"

#include <cmath>
#include <numbers>

#include "tests/algo/allocations.hpp"
#include "tests/algo/pipeline/by_hand.hpp"
#include <gtest/gtest.h>

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

/// At the start the space behind is unknown: the driver must insist.
TEST(StickGuard, BacksIntoUnseenSpaceForAPersistentDriver) {
  ByHand robot;
  robot.start();
  robot.hold({-1, 0}, 1.9);
  EXPECT_EQ(robot.pose.x, 0);
  robot.hold({-1, 0}, 2);
  EXPECT_LT(robot.pose.x, -0.1);
  EXPECT_LE(robot.fastest_back, 0.1 + 1e-9);
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
  EXPECT_GT(robot.least, 0.03);
  EXPECT_LT(robot.least, 0.15);
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
