// tests/sim/floor_sensors_test.cpp: the model of the sensors that look at the floor.
#include "sim/floor_sensors.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "algo/terrain/ground_value.hpp"
#include "algo/terrain/psd_curve.hpp"
#include "algo/units.hpp"

namespace {

using namespace algo::units;

sim::FloorSensorConfig exact() {
  return {.noise = 0, .spot = 0, .glitches = 0};
}
/// [m] One count of the converter, at 28 cm.
constexpr double kCount = 0.003;

TEST(FloorSensors, MeasureALevelFloor) {
  sim::FloorSensorModel sensors(exact(), 1);
  const algo::FloorRanges r = sensors.read(2, {1, 2, 0.7}, {});
  EXPECT_EQ(r.stamp, 2);
  EXPECT_NEAR(r.near_left, 0.20, kCount);
  EXPECT_NEAR(r.near_right, 0.20, kCount);
  EXPECT_NEAR(r.far_left, 0.28, kCount);
  EXPECT_NEAR(r.far_right, 0.28, kCount);
}

TEST(FloorSensors, TellLeftFromRight) {
  sim::FloorSensorModel sensors(exact(), 1);
  sensors.add({.id = 1, .pose_W = {0.5, 1, 0}, .shape = algo::Ramp{2, 2, 0.02}, .height = 0.02});
  const algo::FloorRanges r = sensors.read(0, {}, {});
  EXPECT_NEAR(r.near_left, 0.20 - 0.02 * std::sqrt(2), kCount);
  EXPECT_NEAR(r.near_right, 0.20, kCount);
}

/// A robot with its nose up by 10 degrees reads a level floor as a slope down.
TEST(FloorSensors, TiltWithTheRobot) {
  sim::FloorSensorModel sensors(exact(), 1);
  const algo::FloorRanges r = sensors.read(0, {}, {.pitch = -10_deg});
  EXPECT_NEAR(algo::ground_slope(r.far_left, r.near_left, 0.08, 45_deg), -10_deg, 1_deg);
  const algo::FloorRanges rolled = sensors.read(0, {}, {.roll = 5_deg});
  EXPECT_GT(rolled.near_left, rolled.near_right);
}

TEST(FloorSensors, SeeNothingBeyondTheirRange) {
  sim::FloorSensorModel sensors(exact(), 1);
  const algo::FloorRanges r = sensors.read(0, {}, {.z = 0.9});
  EXPECT_TRUE(std::isnan(r.far_left));
  EXPECT_TRUE(std::isnan(r.near_right));
}

/// Noise of a voltage is small near and large far away.
TEST(FloorSensors, NoiseGrowsWithTheSquareOfTheDistance) {
  const auto spread = [](double z) {
    sim::FloorSensorModel sensors({.glitches = 0}, 3);
    double sum = 0;
    double squares = 0;
    constexpr int kReadings = 2000;
    for (int k = 0; k < kReadings; ++k) {
      const double range = sensors.read(0, {}, {.z = z}).near_left;
      sum += range;
      squares += range * range;
    }
    return std::sqrt(squares / kReadings - sum * sum / kReadings / kReadings);
  };
  const double near = spread(0);                       // 20 cm
  const double far = spread(0.20 * std::sin(45_deg));  // 40 cm
  EXPECT_NEAR(near, 0.0011, 0.0001);
  EXPECT_NEAR(far / near, 3.9, 0.4);
}

TEST(FloorSensors, GrazingLightVariesMore) {
  const auto widest = [](bool grazing) {
    sim::FloorSensorModel sensors({.glitches = 0, .grazing = grazing}, 3);
    double most = 0;
    for (int k = 0; k < 500; ++k) {
      most = std::max(most, sensors.read(0, {}, {.pitch = -20_deg}).near_left);
    }
    return most;
  };
  EXPECT_GT(widest(true), widest(false) + 0.005);
}

TEST(FloorSensors, GlitchesAreRare) {
  sim::FloorSensorModel sensors({.noise = 0, .spot = 0}, 9);
  int glitches = 0;
  for (int k = 0; k < 5000; ++k) {
    const algo::FloorRanges r = sensors.read(0, {}, {});
    for (const double range : {r.far_left, r.far_right, r.near_left, r.near_right}) {
      const double truth = range == r.far_left || range == r.far_right ? 0.28 : 0.20;
      if (std::abs(range - truth) > 0.01) ++glitches;
    }
  }
  EXPECT_NEAR(glitches, 0.005 * 20000 * 0.9, 30);
}

TEST(FloorSensors, SameSeedGivesTheSameReadings) {
  sim::FloorSensorModel a({}, 4);
  sim::FloorSensorModel b({}, 4);
  sim::FloorSensorModel c({}, 5);
  bool differ = false;
  for (int k = 0; k < 100; ++k) {
    const algo::FloorRanges x = a.read(k, {}, {});
    EXPECT_EQ(x, b.read(k, {}, {}));
    differ = differ || !(x == c.read(k, {}, {}));
  }
  EXPECT_TRUE(differ);
}

TEST(FloorSensors, RefuseWhatCannotBe) {
  EXPECT_FALSE(sim::defect(sim::FloorSensorConfig{}).has_value());
  EXPECT_EQ(sim::defect(sim::FloorSensorConfig{.noise = -1}), "noise must be 0 to 1 V");
  EXPECT_EQ(sim::defect(sim::FloorSensorConfig{.height = 0.05}),
            "height, angle and separation put the floor outside the sensor's 0.1 to 0.8 m");
  EXPECT_THROW(sim::FloorSensorModel({.angle = 2}, 1), std::invalid_argument);
}

}  // namespace
