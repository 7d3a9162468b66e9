// tests/sim/drive_errors_test.cpp: delay, slip and drift, and obstacles that move by themselves.
#include "sim/drive_errors.hpp"

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "server/run/robot_library.hpp"
#include "sim/world.hpp"

namespace sim {
namespace {

TEST(DriveErrors, NoErrorsLeaveTheRunUnchanged) {
  DriveErrors errors({}, 1);
  errors.reset({1, 2, 0.3});
  EXPECT_EQ(errors.act({0.5, -0.2}), (algo::Twist2{0.5, -0.2}));
  const algo::Odometry sound{0.1, {1.1, 2.1, 0.4}, {0.5, 0.1}};
  EXPECT_EQ(errors.report(sound), sound);
}

TEST(DriveErrors, ACommandActsAfterItsDelayAndSlips) {
  DriveErrors errors({.delay_ticks = 2, .yaw_slip = 0.1}, 1);
  errors.reset({});
  EXPECT_EQ(errors.act({1, 1}), algo::Twist2{});
  EXPECT_EQ(errors.act({2, 2}), algo::Twist2{});
  EXPECT_EQ(errors.act({3, 3}), (algo::Twist2{1, 0.9}));
  EXPECT_EQ(errors.act({4, 4}), (algo::Twist2{2, 1.8}));
}

TEST(DriveErrors, TheOdometryDriftsByItsScaleEachWayForSomeSeed) {
  bool longer = false;
  bool shorter = false;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    DriveErrors errors({.odometry_scale = 0.02}, seed);
    errors.reset({});
    algo::Odometry reported;
    for (int k = 1; k <= 100; ++k) reported = errors.report({0.1 * k, {0.1 * k, 0, 0}, {1, 0}});
    EXPECT_NEAR(std::abs(reported.pose.x - 10), 0.2, 1e-9);
    EXPECT_EQ(reported.pose.y, 0);
    longer |= reported.pose.x > 10;
    shorter |= reported.pose.x < 10;
  }
  EXPECT_TRUE(longer && shorter);
}

TEST(DriveErrors, NoiseDependsOnTheSeed) {
  const auto end = [](std::uint64_t seed) {
    DriveErrors errors({.odometry_noise = 0.02}, seed);
    errors.reset({});
    algo::Odometry reported;
    for (int k = 1; k <= 50; ++k) reported = errors.report({0.1 * k, {0.1 * k, 0, 0.02 * k}, {}});
    return reported.pose;
  };
  EXPECT_EQ(end(3), end(3));
  EXPECT_NE(end(3), end(4));
}

TEST(DriveErrors, ConfigurationErrorsAreNamed) {
  EXPECT_EQ(defect(DriveConfig{.yaw_slip = 1}), "yaw_slip must be 0 to below 1");
  EXPECT_EQ(defect(DriveConfig{.max_v = 0}), "limits must be above 0");
  EXPECT_EQ(defect(DriveConfig{.delay_ticks = 101}), "delay_ticks must be 0 to 100");
  EXPECT_EQ(defect(DriveConfig{.odometry_scale = std::nan("")}),
            "odometry_scale must be within -1 and 1");
  EXPECT_FALSE(defect(DriveConfig{}));
}

algo::ObstaclePath path() {
  return {.period = 4, .keys = {{0, {2, 0}}, {1, {3, 0}}, {4, {3, 3}}}};
}

TEST(ObstaclePath, IsLinearBetweenKeysAndJumpsBack) {
  const algo::ObstaclePath p = path();
  EXPECT_EQ(p.at(0), algo::Vec2(2, 0));
  EXPECT_EQ(p.at(0.5), algo::Vec2(2.5, 0));
  EXPECT_EQ(p.at(2.5), algo::Vec2(3, 1.5));
  EXPECT_EQ(p.at(4), algo::Vec2(2, 0));
  EXPECT_EQ(p.at(8.5), algo::Vec2(2.5, 0));
  algo::ObstaclePath later = path();
  later.phase = 0.5;
  EXPECT_EQ(later.at(0), algo::Vec2(2.5, 0));
}

TEST(ObstaclePath, OneThatComesAndGoesIsThereFromItsFirstKeyToItsLast) {
  algo::ObstaclePath p{.period = 4, .keys = {{1, {2, 0}}, {3, {3, 0}}}};
  EXPECT_TRUE(p.is_there(0.5)) << "it stands at its first key";
  p.comes_and_goes = true;
  EXPECT_FALSE(p.is_there(0.99));
  EXPECT_TRUE(p.is_there(1));
  EXPECT_TRUE(p.is_there(3));
  EXPECT_FALSE(p.is_there(3.01));
  EXPECT_TRUE(p.is_there(5)) << "the path repeats";
  p.phase = 1;
  EXPECT_TRUE(p.is_there(0));
  EXPECT_FALSE(p.is_there(2.5));
}

Scenario moving_scenario(PhysicsKind physics) {
  Scenario scenario;
  scenario.physics = physics;
  scenario.period = 0.1;
  scenario.obstacles = {
      {.id = 1, .pose_W = {2, 0, 0}, .shape = algo::Cylinder{0.3}, .path = path()}};
  return scenario;
}

TEST(World, AnObstacleFollowsItsPathAndTheScannerSeesIt) {
  for (const PhysicsKind physics : {PhysicsKind::Kinematic, PhysicsKind::Bullet}) {
    World world(moving_scenario(physics), 1);
    algo::Observation observation;
    world.reset(observation);
    EXPECT_NEAR(world.ground_truth()->obstacle_distance, 1.7, 1e-9);
    for (int k = 0; k < 10; ++k) world.step({}, observation);
    EXPECT_NEAR(world.ground_truth()->obstacle_distance, 2.7, 1e-9);
    ASSERT_FALSE(observation.scans.empty());
    EXPECT_NEAR(observation.scans[0].ranges[180], 2.65, 0.15);
    EXPECT_EQ(world.edit(algo::MoveObstacle{1, {5, 5, 0}}), "Obstacle 1 moves by itself.");
    EXPECT_FALSE(world.edit(algo::RemoveObstacle{1}));
    EXPECT_TRUE(world.step({}, observation));
    world.reset(observation);
    EXPECT_NEAR(world.ground_truth()->obstacle_distance, 1.7, 1e-9);
  }
}

TEST(World, SomethingThatDrivesIntoTheRobotIsACollision) {
  Scenario scenario = moving_scenario(PhysicsKind::Kinematic);
  scenario.obstacles[0].path->keys = {{0, {2, 0}}, {2, {0.2, 0}}};
  World world(scenario, 1);
  algo::Observation observation;
  world.reset(observation);
  for (int k = 0; k < 10; ++k) world.step({}, observation);
  EXPECT_FALSE(world.ground_truth()->collided);
  for (int k = 0; k < 9; ++k) world.step({}, observation);
  EXPECT_TRUE(world.ground_truth()->collided);
}

TEST(World, APostBesideTheWheelsDoesNotBlock) {
  // The wheels' support balls are wider than the hull; 3 cm beside it there is room.
  Scenario scenario;
  scenario.robot = server::builtin_robot("jackal");
  scenario.period = 0.05;
  scenario.obstacles = {
      {.id = 1, .pose_W = {1, 0.215 + 0.03 + 0.075, 0}, .shape = algo::Cylinder{0.075}}};
  World world(scenario, 1);
  algo::Observation observation;
  world.reset(observation);
  for (int k = 0; k < 80; ++k) world.step({{0.5, 0}}, observation);
  EXPECT_GT(world.ground_truth()->pose.x, 1.5);
  EXPECT_NEAR(world.ground_truth()->pose.y, 0, 1e-3);
  EXPECT_FALSE(world.ground_truth()->collided);
}

}  // namespace
}  // namespace sim
