// tests/sim/sensor_suite_test.cpp: infrared scanners, gyro, bumpers and the sources of odometry.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "sim/drive_errors.hpp"
#include "sim/gyro_model.hpp"
#include "sim/infrared_model.hpp"
#include "sim/world.hpp"

namespace sim {
namespace {

using algo::Beam;

algo::Obstacle post(std::uint32_t id, double x, double y, double height = 1.0) {
  algo::Obstacle obstacle{.id = id, .pose_W = {x, y, 0}, .shape = algo::Cylinder{0.2}};
  obstacle.height = height;
  return obstacle;
}

InfraredConfig narrow() {
  InfraredConfig config;
  config.beams = 3;
  config.field = 0.2;
  config.noise = 0;
  return config;
}

TEST(InfraredModel, MeasuresAlongItsBeamsOncePerPeriod) {
  InfraredModel scanner(narrow(), 1, 0);
  scanner.add(post(1, 2, 0));
  PoseTrail trail(0.01, 1);
  trail.reset({}, 0);
  algo::Recycled<algo::RangeReading> readings;
  int scans = 0;
  for (int tick = 0; tick < 100; ++tick) {
    readings.clear();
    const double now = 0.01 * tick;
    scanner.sense(now, trail, readings);
    if (readings.empty()) continue;
    ++scans;
    ASSERT_EQ(readings.size(), 3U);
    EXPECT_NEAR(readings[1].range, 1.8, 1e-9);
    EXPECT_EQ(readings[1].status, Beam::Ok);
    EXPECT_NEAR(readings[0].mount_R.heading, -0.1, 1e-12);
    EXPECT_LE(readings[0].stamp, now + 1e-9);
    EXPECT_GT(readings[0].stamp, now - 0.18 - 1e-9);
  }
  EXPECT_GE(scans, 5);  // of 0.18 s in one second
  EXPECT_LE(scans, 6);
}

TEST(InfraredModel, SeesLowObstaclesAndNothingBeyondItsRange) {
  InfraredModel scanner(narrow(), 1, 0);
  scanner.add(post(1, 2, 0, 0.15));
  PoseTrail trail(0.01, 1);
  trail.reset({}, 0);
  algo::Recycled<algo::RangeReading> readings;
  scanner.sense(0.5, trail, readings);
  ASSERT_EQ(readings.size(), 3U);
  EXPECT_EQ(readings[1].status, Beam::Ok);
  readings.clear();
  scanner.move(1, {5, 0, 0});
  scanner.sense(1.0, trail, readings);
  ASSERT_EQ(readings.size(), 3U);
  EXPECT_EQ(readings[1].status, Beam::Free);
  EXPECT_EQ(readings[1].range, 3.5);
}

TEST(InfraredModel, ErrorsAreSentences) {
  InfraredConfig config;
  config.beams = 0;
  EXPECT_EQ(defect(config), "beams must be 1 to 361");
  config = {};
  config.period = 0;
  EXPECT_EQ(defect(config), "period must be 0.001 to 1 s");
  EXPECT_THROW(InfraredModel(config, 1, 0), std::invalid_argument);
  EXPECT_FALSE(defect(InfraredConfig{}));
}

TEST(GyroModel, ReadsTheRateWithBiasAndNoise) {
  GyroModel ideal({}, 1);
  EXPECT_EQ(ideal.read(0.3, 0.02), 0.3);
  GyroModel biased({.bias = 0.01}, 1);
  const double bias = biased.read(0, 0.02);
  EXPECT_NE(bias, 0);
  EXPECT_EQ(biased.read(0, 0.02), bias);
  EXPECT_NE(GyroModel({.bias = 0.01}, 2).read(0, 0.02), bias);
  EXPECT_EQ(defect(GyroConfig{.noise = -1}), "noise must be 0 to 1 rad/s");
}

/// A robot in the open that turns left for 20 s.
struct Turn {
  algo::Pose2 odometry{};
  algo::Pose2 truth{};
};
Turn turn(PhysicsKind physics, Localization localization) {
  Scenario scenario;
  scenario.physics = physics;
  scenario.robot.sensors.lasers.clear();
  scenario.period = 0.05;
  scenario.drive.odometry_slip = 0.05;
  scenario.robot.sensors.gyro = GyroConfig{.bias = 0.01, .bias_walk = 1e-4, .noise = 0.005};
  scenario.localization = localization;
  World world(scenario, 3);
  algo::Observation observation;
  world.reset(observation);
  for (int k = 0; k < 400; ++k) world.step({{0.2, 0.5}}, observation);
  return {observation.odometry.pose, world.ground_truth()->pose};
}

TEST(World, TheGyroCorrectsWheelSlip) {
  for (const PhysicsKind physics : {PhysicsKind::Kinematic, PhysicsKind::Bullet}) {
    const auto error = [&](Localization localization) {
      const Turn drive = turn(physics, localization);
      return std::abs(algo::wrap_angle(drive.odometry.heading - drive.truth.heading));
    };
    EXPECT_GT(error(Localization::Encoders), 0.3);  // 5 % of 10 rad
    EXPECT_LT(error(Localization::Gyro), 0.1);
  }
}

TEST(World, ThreeBumpersLocateTheContact) {
  Scenario scenario;
  scenario.period = 0.05;
  scenario.robot.sensors.bumpers = 3;
  // Behind, to the left; the robot backs into it.
  scenario.obstacles = {post(1, -0.75, 0.15)};
  World world(scenario, 1);
  algo::Observation observation;
  world.reset(observation);
  ASSERT_EQ(observation.bumpers.size(), 3U);
  EXPECT_FALSE(observation.bumper_pressed());
  EXPECT_NEAR(observation.bumpers[1].mount_R.heading, 2 * std::numbers::pi / 3, 1e-9);
  for (int k = 0; k < 60 && !observation.bumper_pressed(); ++k) {
    world.step({{-0.2, 0}}, observation);
  }
  EXPECT_FALSE(observation.bumpers[0].pressed);
  EXPECT_TRUE(observation.bumpers[1].pressed);
  EXPECT_FALSE(observation.bumpers[2].pressed);
}

TEST(World, EachSensorCanBeLeftOut) {
  Scenario scenario;
  scenario.robot.sensors.has_gyro = false;
  scenario.robot.sensors.bumpers = 0;
  scenario.robot.sensors.encoders = false;
  World world(scenario, 1);
  algo::Observation observation;
  world.reset(observation);
  world.step({}, observation);
  EXPECT_FALSE(observation.gyro);
  EXPECT_FALSE(observation.encoders);
  EXPECT_TRUE(observation.bumpers.empty());
  EXPECT_TRUE(observation.infrared.empty());
  scenario.localization = Localization::Gyro;
  EXPECT_THROW(World(scenario, 1), std::invalid_argument);
}

TEST(World, FrontAndRearScannersReportFromTheirMounts) {
  Scenario scenario;
  scenario.physics = PhysicsKind::Kinematic;
  InfraredConfig rear;
  rear.mount_R = {-0.3, 0, std::numbers::pi};
  scenario.robot.sensors.infrared = {InfraredConfig{}, rear};
  scenario.obstacles = {post(1, -1.5, 0, 0.15)};
  World world(scenario, 1);
  algo::Observation observation;
  world.reset(observation);
  std::size_t ahead = 0;
  std::size_t behind = 0;
  for (int k = 0; k < 20; ++k) {
    world.step({}, observation);
    for (const algo::RangeReading& reading : observation.infrared) {
      if (reading.status == Beam::Ok) ++(reading.mount_R.x < 0 ? behind : ahead);
    }
  }
  EXPECT_GT(behind, 5U);
  EXPECT_EQ(ahead, 0U);
}

TEST(ReportedPath, SlipIsAddedToTheReportedTurn) {
  std::vector<algo::Pose2> path{{0, 0, 0}, {1, 0, 0}, {1, 0, 0.95}};
  const auto reported = reported_path(path, {.odometry_slip = 0.05}, 1);
  ASSERT_EQ(reported.size(), 3U);
  EXPECT_EQ(reported[0], path[0]);
  EXPECT_NEAR(reported[1].x, 1, 1e-12);
  EXPECT_NEAR(reported[2].heading, 1, 1e-12);
  EXPECT_TRUE(reported_path({}, {}, 1).empty());
}

}  // namespace
}  // namespace sim
