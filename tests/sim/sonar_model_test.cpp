// tests/sim/sonar_model_test.cpp: the order of the pings, and which echo returns.
#include "sim/sonar_model.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "sim/robot_model.hpp"

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

/// Eight in a front semicircle, all within 100 ms, without noise.
SonarConfig robhaz_ring() {
  SonarConfig config;
  config.count = 8;
  config.field = std::numbers::pi;
  config.ping = 0.0125;
  config.range_max = 3;
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
  sim::SonarModel sonar(config, {.radius = 0.2}, 1);
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
  sim::SonarModel sonar(config, {.radius = 0.2}, 1);
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
  sim::SonarModel sonar(config, {.radius = 0.2}, 1);
  sim::PoseTrail trail(0.01, 1);
  trail.reset({}, 0);
  algo::Recycled<algo::RangeReading> readings;
  sonar.sense(7 * 0.04, trail, readings);
  ASSERT_EQ(readings.size(), 8U);
  EXPECT_NEAR(readings[0].mount_R.heading, -std::numbers::pi / 2, 1e-12);
  EXPECT_NEAR(readings[7].mount_R.heading, std::numbers::pi / 2, 1e-12);
}

/// The axes of a rectangle of 0.66 x 0.40 m leave it ahead at 0.33 m and at the sides at 0.20 m.
TEST(SonarModel, SitsOnTheOutlineOfARectangle) {
  SonarConfig config = robhaz_ring();
  sim::SonarModel sonar(config, {.radius = 0.386, .half_length = 0.33, .half_width = 0.2}, 1);
  sim::PoseTrail trail(0.01, 1);
  trail.reset({}, 0);
  algo::Recycled<algo::RangeReading> readings;
  sonar.sense(7 * config.ping, trail, readings);
  ASSERT_EQ(readings.size(), 8U);
  EXPECT_NEAR(readings[0].mount_R.y, -0.2, 1e-12);
  EXPECT_NEAR(readings[7].mount_R.y, 0.2, 1e-12);
  for (const std::size_t ahead : {3U, 4U}) EXPECT_NEAR(readings[ahead].mount_R.x, 0.33, 1e-12);
  EXPECT_LE(readings[7].stamp - readings[0].stamp, 0.1);
}

/// Two sonars 25.7 degrees apart ping 12.5 ms apart, in which sound goes there and back over 2.14
/// m. A post on the first one's axis, outside the second one's cone, comes back to the second.
TEST(SonarModel, CrosstalkIsALateEchoOfThePingBefore) {
  const double head_start = 343 * 0.0125 / 2;
  const auto second_reading = [](bool crosstalk, double distance) {
    SonarConfig config = robhaz_ring();
    config.crosstalk = crosstalk;
    sim::SonarModel sonar(config, {.radius = 0.2}, 1);
    const algo::Vec2 at = (0.2 + distance + 0.1) * algo::direction(-std::numbers::pi / 2);
    sonar.add(post(at.x(), at.y(), 0.1));
    sim::PoseTrail trail(0.01, 1);
    trail.reset({}, 0);
    algo::Recycled<algo::RangeReading> readings;
    sonar.sense(config.ping, trail, readings);
    EXPECT_NEAR(readings[0].range, distance, 1e-3);
    return readings[1];
  };
  EXPECT_EQ(second_reading(false, 2.7).status, Beam::Free);
  const algo::RangeReading phantom = second_reading(true, 2.7);
  EXPECT_EQ(phantom.status, Beam::Ok);
  EXPECT_NEAR(phantom.range, 2.7 - head_start, 1e-3);
  EXPECT_EQ(second_reading(true, 2.0).status, Beam::Free) << "it came back before the second ping";
}

TEST(SonarModel, SlowPingsHaveNoCrosstalk) {
  SonarConfig config;  // 40 ms: 6.9 m
  config.crosstalk = true;
  config.noise = 0;
  config.cone = std::numbers::pi / 3;
  SonarConfig without = config;
  without.crosstalk = false;
  std::vector<double> ranges[2];
  for (const bool crosstalk : {false, true}) {
    sim::SonarModel sonar(crosstalk ? config : without, {.radius = 0.2}, 1);
    sonar.add(post(4, 1, 0.5));
    sim::PoseTrail trail(0.01, 1);
    trail.reset({}, 0);
    algo::Recycled<algo::RangeReading> readings;
    sonar.sense(1, trail, readings);
    for (const algo::RangeReading& each : readings) ranges[crosstalk].push_back(each.range);
  }
  EXPECT_EQ(ranges[0], ranges[1]);
}

sim::RobotModel with_sonar(const SonarConfig& sonar) {
  sim::RobotModel robot;
  robot.sensors.sonar = sonar;
  return robot;
}

TEST(SonarModel, ARobotHasTheRingIfItCoversTheAxesWithinATenthOfASecond) {
  EXPECT_FALSE(spec_of(sim::RobotModel{}, 0.02).has_ring);
  EXPECT_TRUE(spec_of(with_sonar(robhaz_ring()), 0.02).has_ring);
  SonarConfig slow = robhaz_ring();
  slow.ping = 0.04;
  EXPECT_FALSE(spec_of(with_sonar(slow), 0.02).has_ring) << "a round takes 0.32 s";
  SonarConfig narrow = robhaz_ring();
  narrow.field = std::numbers::pi / 2;
  EXPECT_FALSE(spec_of(with_sonar(narrow), 0.02).has_ring) << "nothing looks to the sides";
  SonarConfig whole_turn;  // 12 all round
  whole_turn.ping = 0.008;
  EXPECT_TRUE(spec_of(with_sonar(whole_turn), 0.02).has_ring);
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
  EXPECT_THROW(sim::SonarModel(config, {.radius = 0.2}, 1), std::invalid_argument);
}

}  // namespace
