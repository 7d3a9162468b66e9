// tests/sim/sensor_test.cpp: further sensors fill their channels at their own rates.
#include "sim/sensor.hpp"

#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "sim/world.hpp"

namespace sim {
namespace {

SensorConfig battery() {
  return {.sensor = "scripted",
          .channel = "battery.voltage",
          .unit = "V",
          .settings = {{"times", {1, 3}}, {"values", {25, 24}}, {"period", {0.5}}}};
}

Scenario with(std::vector<SensorConfig> sensors) {
  Scenario scenario;
  scenario.physics = PhysicsKind::Kinematic;
  scenario.period = 0.1;
  scenario.start = {0, 0, 0.5};
  scenario.robot.sensors.further = std::move(sensors);
  return scenario;
}

TEST(Sensors, EveryKindOfTheTableIsNamedAndExplained) {
  std::set<std::string_view> names;
  for (const SensorKind& kind : sensor_table()) {
    EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
    EXPECT_FALSE(kind.help.empty()) << kind.name;
    for (const SettingInfo& setting : kind.settings) EXPECT_FALSE(setting.help.empty());
  }
  EXPECT_TRUE(names.contains("scripted"));
}

TEST(Sensors, AScriptedValueIsReadOnceInAPeriodAndIsLinearInBetween) {
  World world(with({battery()}), 1);
  ASSERT_EQ(world.spec().channels.size(), 1U);
  EXPECT_EQ(world.spec().channels[0].name, "battery.voltage");
  EXPECT_EQ(world.spec().channels[0].unit, "V");
  algo::Observation o;
  world.reset(o);
  for (int tick = 0; tick <= 40; ++tick) {
    if (tick > 0) world.step({}, o);
    ASSERT_EQ(o.channels.size(), tick % 5 == 0 ? 1U : 0U) << tick;
    if (o.channels.empty()) continue;
    EXPECT_EQ(o.channels[0].stamp, o.stamp);
    const double expected = 25 - std::clamp(0.1 * tick - 1, 0.0, 2.0) / 2;
    EXPECT_NEAR(o.channels[0].values.at(0), expected, 1e-12) << tick;
  }
  world.reset(o);
  EXPECT_EQ(o.channels.size(), 1U) << "it begins anew with the world";
}

TEST(Sensors, ACompassTurnsWithTheRobotAndItsNoiseDependsOnTheSeed) {
  const SensorConfig compass{.sensor = "compass",
                             .channel = "heading",
                             .settings = {{"north", {0.25}}, {"noise", {0.01}}, {"period", {0}}}};
  const auto readings = [&](std::uint64_t seed) {
    World world(with({battery(), compass}), seed);
    algo::Observation o;
    world.reset(o);
    std::vector<double> out;
    for (int tick = 0; tick < 20; ++tick) {
      world.step({{0, 0.5}}, o);
      const algo::ChannelReading& reading = o.channels[o.channels.size() - 1];
      EXPECT_EQ(reading.channel, 1);
      EXPECT_NEAR(reading.values[0], o.odometry.pose.heading - 0.25, 0.06);
      out.push_back(reading.values[0]);
    }
    return out;
  };
  EXPECT_EQ(readings(1), readings(1));
  EXPECT_NE(readings(1), readings(2));
}

TEST(Sensors, AConfigurationErrorIsASentence) {
  const auto complaint = [](auto change) {
    SensorConfig config = battery();
    change(config);
    return defect(config).value_or("");
  };
  EXPECT_EQ(complaint([](SensorConfig&) {}), "");
  EXPECT_EQ(complaint([](SensorConfig& c) { c.sensor = "nose"; }),
            "sensor 'nose' is unknown; known are compass, scripted");
  EXPECT_EQ(complaint([](SensorConfig& c) { c.channel = "Battery"; }),
            "channel must be 1 to 31 of a-z, 0-9, '.' and '_'");
  EXPECT_EQ(complaint([](SensorConfig& c) { c.settings[2].name = "rate"; }),
            "there is no setting 'rate'");
  EXPECT_EQ(complaint([](SensorConfig& c) { c.settings.erase(c.settings.begin()); }),
            "times is missing: [s] of the run clock, ascending");
  EXPECT_EQ(complaint([](SensorConfig& c) { c.settings[0].values = {3, 3}; }), "times must ascend");
  EXPECT_EQ(complaint([](SensorConfig& c) { c.settings[1].values = {1}; }),
            "values must be as many as times");
  EXPECT_EQ(complaint([](SensorConfig& c) { c.settings[2].values = {std::nan("")}; }),
            "period must be 0 to 3600");
  EXPECT_EQ(complaint([](SensorConfig& c) {
              c.settings[2].values = {1, 2};
            }),
            "period must be a number");
  EXPECT_THROW(World(with({{.sensor = "nose", .channel = "n"}}), 1), std::invalid_argument);
}

}  // namespace
}  // namespace sim
