// tests/sim/world_test.cpp: odometry, truth, edits and refusals of the simulated robot.
#include "sim/world.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <random>

#include "tests/sim/reference_world.hpp"
#include <gtest/gtest.h>

namespace sim {
namespace {

using algo::Observation;
using algo::Pose2;

algo::Obstacle cylinder_at(std::uint32_t id, double x, double y, double radius = 0.3) {
  return {.id = id, .pose_W = {x, y, 0}, .shape = algo::Cylinder{radius}};
}

std::unique_ptr<World> world_of(const Scenario& scenario, std::uint64_t seed = 1) {
  auto world = std::make_unique<World>(scenario, seed);
  return world;
}

std::string failure(const Scenario& scenario) {
  try {
    const World world(scenario, 1);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(World, RefusesScenariosInASentence) {
  Scenario scenario;
  scenario.robot.casters.clear();
  EXPECT_EQ(failure(scenario),
            "The scenario's robot: casters: the robot would tip over; its wheels and casters must "
            "surround the middle of the hull.");
  scenario = {};
  scenario.period = 0;
  EXPECT_EQ(failure(scenario), "The scenario's period must be 0.001 to 1 s.");
  scenario = {};
  scenario.start.x = std::nan("");
  EXPECT_EQ(failure(scenario), "The scenario's start must be finite numbers.");
  scenario = {};
  scenario.obstacles = {cylinder_at(4, 0.53, 0)};  // 0.53 - 0.3 - 0.35 = -0.12
  EXPECT_EQ(failure(scenario), "Obstacle 4 would overlap the robot: 0.12 m too close.");
  scenario.obstacles = {cylinder_at(4, 2, 0), cylinder_at(4, 3, 0)};
  EXPECT_EQ(failure(scenario), "There is an obstacle 4 already.");
  scenario.obstacles = {cylinder_at(4, 2, 0, -1)};
  EXPECT_NE(failure(scenario), "");
  scenario = {};
  scenario.robot.sensors.lasers.front().noise = -1;
  EXPECT_EQ(failure(scenario), "Laser 1: noise must be 0 or more.");
}

TEST(World, EditsAreCarriedOutOrRefusedWithTheReason) {
  for (const PhysicsKind physics : {PhysicsKind::Bullet, PhysicsKind::Kinematic}) {
    Scenario scenario;
    scenario.physics = physics;
    const auto world = world_of(scenario);
    Observation seen;
    world->reset(seen);
    EXPECT_TRUE(std::isinf(world->ground_truth()->obstacle_distance));
    EXPECT_EQ(world->edit(algo::AddObstacle{cylinder_at(1, 2, 0)}), std::nullopt);
    EXPECT_NEAR(world->ground_truth()->obstacle_distance, 1.7, 1e-12);
    EXPECT_EQ(world->edit(algo::AddObstacle{cylinder_at(1, 4, 0)}),
              "There is an obstacle 1 already.");
    EXPECT_EQ(world->edit(algo::AddObstacle{cylinder_at(2, 0.4, 0)}),
              "Obstacle 2 would overlap the robot: 0.25 m too close.");
    EXPECT_EQ(world->edit(algo::MoveObstacle{9, {}}), "There is no obstacle 9.");
    EXPECT_EQ(world->edit(algo::MoveObstacle{1, {0.1, 0, 0}}),
              "Obstacle 1 would overlap the robot: 0.55 m too close.");
    EXPECT_NEAR(world->ground_truth()->obstacle_distance, 1.7, 1e-12);  // it stayed where it was
    EXPECT_EQ(world->edit(algo::MoveObstacle{1, {std::nan(""), 0, 0}}),
              "Obstacle 1: x, y and heading must be finite numbers.");
    EXPECT_EQ(world->edit(algo::MoveObstacle{1, {0, 1, 0}}), std::nullopt);
    EXPECT_NEAR(world->ground_truth()->obstacle_distance, 0.7, 1e-12);
    EXPECT_EQ(world->edit(algo::RemoveObstacle{1}), std::nullopt);
    EXPECT_EQ(world->edit(algo::RemoveObstacle{1}), "There is no obstacle 1.");
    EXPECT_TRUE(std::isinf(world->ground_truth()->obstacle_distance));
  }
}

TEST(World, AnAddedObstacleIsSeenAndBlocks) {
  for (const PhysicsKind physics : {PhysicsKind::Bullet, PhysicsKind::Kinematic}) {
    Scenario scenario;
    scenario.physics = physics;
    scenario.robot.sensors.lasers = {LaserConfig::ideal(0.5)};
    const auto world = world_of(scenario);
    Observation seen;
    world->reset(seen);
    ASSERT_EQ(seen.scans.size(), 1u);  // a flat-time scan is available from the start
    EXPECT_EQ(seen.scans[0].status[180], algo::Beam::Free);
    ASSERT_EQ(world->edit(algo::AddObstacle{cylinder_at(1, 1.5, 0)}), std::nullopt);
    ASSERT_TRUE(world->step({{0.5, 0}}, seen));
    EXPECT_NEAR(seen.scans[0].ranges[180], 1.2 - world->ground_truth()->pose.x, 0.0006);
    bool pressed = false;
    for (int tick = 0; tick < 120; ++tick) {
      ASSERT_TRUE(world->step({{0.5, 0}}, seen));
      pressed = pressed || seen.bumper_pressed();
    }
    EXPECT_TRUE(pressed);
    EXPECT_TRUE(world->ground_truth()->collided);
    EXPECT_LT(world->ground_truth()->pose.x, 0.86);
    // With the obstacle removed, the robot drives on.
    ASSERT_EQ(world->edit(algo::MoveObstacle{1, {1.5, 3, 0}}), std::nullopt);
    for (int tick = 0; tick < 60; ++tick) ASSERT_TRUE(world->step({{0.5, 0}}, seen));
    EXPECT_GT(world->ground_truth()->pose.x, 1.2);
    EXPECT_FALSE(seen.bumper_pressed());
  }
}

TEST(World, EncoderOdometryFollowsTheTruthOnAFreeFloor) {
  Scenario scenario;
  scenario.start = {1, -2, 0.7};
  const auto world = world_of(scenario);
  Observation seen;
  world->reset(seen);
  EXPECT_EQ(seen.odometry.pose, scenario.start);
  EXPECT_EQ(world->ground_truth()->pose, scenario.start);
  double way = 0;
  for (int tick = 0; tick < 400; ++tick) {
    ASSERT_TRUE(world->step({{0.4, 0.5 * std::sin(0.02 * tick)}}, seen));
    way += seen.odometry.twist.v * scenario.period;
  }
  const algo::Vec2 off = seen.odometry.pose.position() - world->ground_truth()->pose.position();
  EXPECT_GT(way, 3.5);
  EXPECT_LT(off.norm(), 0.01 * way);
  EXPECT_NE(seen.odometry.pose, world->ground_truth()->pose);
  EXPECT_NEAR(seen.odometry.twist.v, 0.4, 0.002);
}

TEST(World, EncoderCountsAreTheOdometry) {
  const auto world = world_of({});
  Observation before;
  Observation after;
  world->reset(before);
  for (int tick = 0; tick < 100; ++tick) {
    ASSERT_TRUE(world->step({{-0.3, 0.5}}, after));
    // Silvermate: 40000 counts a turn, wheel radius 0.1 m, half track 0.25 m (equations.md I).
    const double metre = 2 * std::numbers::pi * 0.1 / 40000;
    const double left =
        metre * static_cast<std::int32_t>(after.encoders->left - before.encoders->left);
    const double right =
        metre * static_cast<std::int32_t>(after.encoders->right - before.encoders->right);
    EXPECT_NEAR(after.odometry.twist.v, (left + right) / 2 / 0.026, 1e-9);
    EXPECT_NEAR(after.odometry.twist.omega, (right - left) / 0.5 / 0.026, 1e-9);
    before = after;
  }
  EXPECT_GT(before.encoders->left, 0x80000000U);  // backwards from 0: wrapped around
}

TEST(World, KinematicOdometryIsTheTruth) {
  Scenario scenario;
  scenario.physics = PhysicsKind::Kinematic;
  const auto world = world_of(scenario);
  Observation seen;
  world->reset(seen);
  for (int tick = 0; tick < 50; ++tick) {
    ASSERT_TRUE(world->step({{0.4, 0.3}}, seen));
    EXPECT_EQ(seen.odometry.pose, world->ground_truth()->pose);
    EXPECT_EQ(seen.odometry.twist, (algo::Twist2{0.4, 0.3}));
  }
}

TEST(World, SensorsOfEachVehicle) {
  Observation seen;
  Scenario scenario;
  scenario.robot.sensors.lasers.push_back(LaserConfig::with_resolution(1));
  scenario.robot.sensors.lasers.back().mount_R = {-0.25, 0, std::numbers::pi};
  const auto bullet = world_of(scenario);
  bullet->reset(seen);
  for (int tick = 0; tick < 100; ++tick) ASSERT_TRUE(bullet->step({{0, 0.8}}, seen));
  ASSERT_TRUE(seen.gyro.has_value());
  EXPECT_NEAR(seen.gyro->rate, 0.8, 0.004);
  ASSERT_TRUE(seen.inclinometer.has_value());
  EXPECT_NEAR(seen.inclinometer->roll, 0, 0.01);
  EXPECT_NEAR(seen.inclinometer->pitch, 0, 0.01);
  EXPECT_EQ(seen.bumpers.size(), 1u);
  EXPECT_FALSE(seen.bumper_pressed());
  ASSERT_EQ(seen.scans.size(), 2u);
  EXPECT_EQ(seen.scans[1].size(), 181u);

  scenario.physics = PhysicsKind::Kinematic;
  const auto kinematic = world_of(scenario);
  kinematic->reset(seen);
  EXPECT_FALSE(seen.gyro.has_value());
  EXPECT_FALSE(seen.inclinometer.has_value());
  EXPECT_EQ(seen.bumpers.size(), 1u);
  EXPECT_TRUE(seen.encoders.has_value());
  EXPECT_TRUE(seen.sonar.empty());
}

TEST(World, EditsAtTheSameTickGiveTheSameRun) {
  const auto run = [](int edit_tick) {
    Scenario scenario;
    scenario.obstacles = reference::room(20);
    const auto world = world_of(scenario, 8);
    Observation seen;
    world->reset(seen);
    std::vector<double> all;
    for (int tick = 0; tick < 150; ++tick) {
      if (tick == edit_tick) {
        EXPECT_EQ(world->edit(algo::AddObstacle{cylinder_at(77, 1.0, 1.0)}), std::nullopt);
      }
      EXPECT_TRUE(world->step({{0.4, 0.35}}, seen));
      all.push_back(seen.odometry.pose.x);
      all.push_back(world->ground_truth()->pose.y);
      for (const algo::LaserScan& scan : seen.scans) {
        all.insert(all.end(), scan.ranges.begin(), scan.ranges.end());
      }
    }
    return all;
  };
  EXPECT_EQ(run(20), run(20));
  EXPECT_NE(run(20), run(40));
}

TEST(ObstacleSet, DistanceEqualsTheLeastSignedDistance) {
  std::mt19937_64 random(2);
  const std::vector<algo::Obstacle> room = reference::room(100);
  ObstacleSet set;
  for (const algo::Obstacle& obstacle : room) set.add(obstacle);
  int inside = 0;
  for (int i = 0; i < 2000; ++i) {
    const algo::Vec2 p{reference::uniform(random, -12, 12), reference::uniform(random, -12, 12)};
    double expected = std::numeric_limits<double>::infinity();
    for (const algo::Obstacle& obstacle : room) {
      expected = std::min(expected, algo::signed_distance(obstacle, p));
    }
    EXPECT_NEAR(set.distance(p), expected, 1e-9);
    inside += expected < 0 ? 1 : 0;
  }
  EXPECT_GT(inside, 20);
}

}  // namespace
}  // namespace sim
