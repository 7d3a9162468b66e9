// tests/sim/sonar_model_test.cpp: the order of the pings, and which echo returns.
#include "sim/sonar_model.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace {

using algo::Beam;
using sim::SonarConfig;

/// One sonar ahead on a robot of 0.2 m, without noise.
SonarConfig one_ahead() {
  SonarConfig config;
  config.count = 1;
  config.noise = 0;
  return config;
}

algo::Obstacle post(double x, double y, double radius) {
  return {.id = 1, .pose_W = {x, y, 0}, .shape = algo::Cylinder{radius}};
}

/// A long wall whose near face meets the x axis at `x`, turned by `angle` from perpendicular.
algo::Obstacle wall(double x, double angle) {
  return {.id = 1, .pose_W = {x, 0, std::numbers::pi / 2 + angle}, .shape = algo::Wall{40, 1e-3}};
}

algo::RangeReading first_reading(const SonarConfig& config, const algo::Obstacle& obstacle) {
  sim::SonarModel sonar(config, 0.2, 1);
  sonar.add(obstacle);
  sim::PoseTrail trail(0.01, 1);
  trail.reset({}, 0);
  algo::Recycled<algo::RangeReading> readings;
  sonar.sense(0, trail, readings);
  EXPECT_EQ(readings.size(), 1U);
  return readings[0];
}

TEST(SonarModel, MeasuresFromTheHullToTheNearestSurfaceOfTheCone) {
  EXPECT_NEAR(first_reading(one_ahead(), post(2, 0, 0.3)).range, 1.5, 1e-3);
  // 10 degrees off the axis and still in the cone of 15 degrees either side.
  const double off = 10 * std::numbers::pi / 180;
  const algo::Vec2 centre = algo::Vec2(0.2, 0) + 1.8 * algo::direction(off);
  EXPECT_NEAR(first_reading(one_ahead(), post(centre.x(), centre.y(), 0.3)).range, 1.5, 1e-3);
  EXPECT_EQ(first_reading(one_ahead(), post(0.5, 1.9, 0.3)).status, Beam::Free);
}

TEST(SonarModel, FreeBeyondItsRangeAndNeverBelowTheLeast) {
  const algo::RangeReading far = first_reading(one_ahead(), post(6, 0, 0.3));
  EXPECT_EQ(far.status, Beam::Free);
  EXPECT_EQ(far.range, 5.0);
  EXPECT_EQ(first_reading(one_ahead(), post(0.55, 0, 0.3)).range, 0.15);  // 5 cm away
}

TEST(SonarModel, AWallMetTooObliquelyGivesNoEcho) {
  const auto turned = [](double degrees) { return wall(2, degrees * std::numbers::pi / 180); };
  EXPECT_EQ(first_reading(one_ahead(), turned(0)).status, Beam::Ok);
  EXPECT_EQ(first_reading(one_ahead(), turned(60)).status, Beam::Ok);
  EXPECT_EQ(first_reading(one_ahead(), turned(78)).status, Beam::Free);
  SonarConfig diffuse = one_ahead();
  diffuse.incidence = std::numbers::pi / 2;
  EXPECT_EQ(first_reading(diffuse, turned(78)).status, Beam::Ok);
}

TEST(SonarModel, SensorsPingInTurn) {
  SonarConfig config;
  config.count = 4;
  sim::SonarModel sonar(config, 0.2, 1);
  sim::PoseTrail trail(0.01, 1);
  trail.reset({}, 0);
  algo::Recycled<algo::RangeReading> readings;
  for (int tick = 0; tick <= 20; ++tick) {
    const std::size_t before = readings.size();
    sonar.sense(0.025 * tick, trail, readings);
    EXPECT_LE(readings.size(), before + 1) << "a ping every 40 ms";
  }
  ASSERT_EQ(readings.size(), 13U);  // 0, 0.04 .. 0.48 s
  for (std::size_t k = 0; k < readings.size(); ++k) {
    EXPECT_NEAR(readings[k].stamp, 0.04 * static_cast<double>(k), 1e-12);
    const double axis = std::numbers::pi / 2 * static_cast<double>(k % 4);
    EXPECT_NEAR(algo::wrap_angle(readings[k].mount_R.heading - axis), 0, 1e-12);
    EXPECT_NEAR(readings[k].mount_R.position().norm(), 0.2, 1e-12);
  }
}

TEST(SonarModel, APartOfATurnHasASensorAtEitherBorder) {
  SonarConfig config;
  config.count = 8;
  config.field = std::numbers::pi;
  sim::SonarModel sonar(config, 0.2, 1);
  sim::PoseTrail trail(0.01, 1);
  trail.reset({}, 0);
  algo::Recycled<algo::RangeReading> readings;
  sonar.sense(7 * 0.04, trail, readings);
  ASSERT_EQ(readings.size(), 8U);
  EXPECT_NEAR(readings[0].mount_R.heading, -std::numbers::pi / 2, 1e-12);
  EXPECT_NEAR(readings[7].mount_R.heading, std::numbers::pi / 2, 1e-12);
}

TEST(SonarModel, ConfigurationErrorsAreSentences) {
  EXPECT_FALSE(sim::defect(SonarConfig{}));
  SonarConfig config;
  config.count = 0;
  EXPECT_EQ(sim::defect(config), "count must be 1 to 64");
  config = {};
  config.range_min = 6;
  EXPECT_TRUE(sim::defect(config));
  config = {};
  config.ping = std::nan("");
  EXPECT_TRUE(sim::defect(config));
  EXPECT_THROW(sim::SonarModel(config, 0.2, 1), std::invalid_argument);
}

}  // namespace
