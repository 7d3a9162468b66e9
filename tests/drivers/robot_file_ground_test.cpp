// tests/drivers/robot_file_ground_test.cpp: what a robot's file says about the ground.
#include <numbers>
#include <string>

#include "tests/drivers/robot_error.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/robot_file.hpp"

namespace drivers {
namespace {

using ::testing::HasSubstr;

/// A file of eleven lines that ends with `more`.
std::string with(const std::string& more) {
  return R"(name = "a"
hull = { radius = 0.35 }
[[laser]]
port = "/dev/lms-front"
[base]
type = "roboteq"
port = "/dev/roboteq"
track = 0.5
wheel_radius = 0.1
gear = 20
encoder_lines = 500
)" + more;
}
const std::string kPsd =
    "[psd]\nport = \"/dev/psd\"\nx = 0.35\nheight = 0.1414\nhalf_spacing = 0.1\n";

TEST(RobotFileGround, WithoutItsTablesThereAreNoSenses) {
  const RobotFile robot = parse_robot(with(""), "my.toml");
  EXPECT_FALSE(robot.floor || robot.spec.floor || robot.spec.climbs);
  EXPECT_FALSE(robot.spec.inclinometer);
}

TEST(RobotFileGround, FiveLinesDescribeTheFloorSensors) {
  const RobotFile robot = parse_robot(with(kPsd), "my.toml");
  ASSERT_TRUE(robot.floor && robot.spec.floor);
  EXPECT_EQ(robot.floor->port, "/dev/psd");
  EXPECT_EQ(robot.floor->setup.baud, 115'200U);
  EXPECT_TRUE(robot.floor->setup.tables[0].points().empty()) << "the usual curve";
  EXPECT_EQ(*robot.spec.floor, (algo::FloorSensors{0.35, 0.1414, 0.1, std::numbers::pi / 4, 0.08}));
}

TEST(RobotFileGround, EachSensorMayHaveItsOwnTable) {
  const RobotFile robot =
      parse_robot(with(kPsd + "rate = 57600\nfull_scale = 5\nangle_deg = 50\nseparation = 0.1\n"
                              "near_left = [[2.5, 0.1], [1.3, 0.2], [0.4, 0.8]]\n"),
                  "my.toml");
  const psd::PsdSetup& setup = robot.floor->setup;
  EXPECT_EQ(setup.baud, 57600U);
  EXPECT_EQ(setup.full_scale, 5);
  EXPECT_EQ(setup.tables[2].points().size(), 3U);
  EXPECT_EQ(setup.tables[2].points()[1], (psd::TablePoint{1.3, 0.2}));
  EXPECT_TRUE(setup.tables[3].points().empty());
  EXPECT_NEAR(robot.spec.floor->angle, 50 * std::numbers::pi / 180, 1e-12);
}

TEST(RobotFileGround, WhatItClimbsIsRead) {
  const RobotFile robot =
      parse_robot(with("[climbs]\nstep_up = 0.013\nstep_down = 0.02\n"
                       "trench = 0.05\nslope_up_deg = 10\nslope_down_deg = 8\n"),
                  "my.toml");
  ASSERT_TRUE(robot.spec.climbs);
  EXPECT_EQ(robot.spec.climbs->step_up, 0.013);
  EXPECT_EQ(robot.spec.climbs->trench, 0.05);
  EXPECT_NEAR(robot.spec.climbs->slope_down, 8 * std::numbers::pi / 180, 1e-12);
}

/// The file with `first` before its first table.
std::string with_keys(const std::string& first, const std::string& more) {
  return first + with(more);
}

TEST(RobotFileGround, PublishedSensorsAreNamed) {
  const RobotFile robot = parse_robot(
      with_keys("inclinometer = \"published\"\nlaser_line = \"published\"\n",
                "[stance]\nmass_height = 0.9\nlength = 0.4\n[line_camera]\nx = 0.1\nheight = 0.45\n"
                "pitch_deg = 20\nbaseline = 0.2\nangle_deg = 30\nfocal = 600\n"),
      "my.toml");
  EXPECT_TRUE(robot.published.inclinometer && robot.published.line);
  EXPECT_TRUE(robot.spec.inclinometer) << "its silence holds the robot";
  ASSERT_TRUE(robot.spec.stance && robot.spec.line);
  EXPECT_EQ(*robot.spec.stance, (algo::Stance{0.9, 0.5, 0.4}));
  EXPECT_EQ(robot.spec.line->columns, 640);
  EXPECT_NEAR(robot.spec.line->angle, std::numbers::pi / 6, 1e-12);
}

TEST(RobotFileGround, ASenseWithoutItsSourceIsRefused) {
  EXPECT_EQ(error_of(with_keys("inclinometer = \"i2c\"\n", "")),
            "my.toml:1: inclinometer is 'i2c'; it can be published");
  EXPECT_EQ(error_of(with("[stance]\nmass_height = 0.9\nlength = 0.4\n")),
            "my.toml:13: [stance] mass_height needs the robot's inclination: inclinometer = "
            "\"published\"");
  EXPECT_EQ(error_of(with("[line_camera]\nx = 0\n")),
            "my.toml:12: line_camera needs laser_line = \"published\": no driver reads a camera");
  EXPECT_EQ(error_of(with_keys("laser_line = \"published\"\n", "")),
            "my.toml:1: there is no [line_camera]");
}

TEST(RobotFileGround, MistakesAreNamedWithTheirLine) {
  EXPECT_EQ(error_of(with("[psd]\nport = \"/dev/psd\"\n")), "my.toml:12: [psd] x is missing");
  EXPECT_EQ(error_of(with(kPsd + "near_left = 3\n")),
            "my.toml:17: [psd] near_left must be a list of pairs of numbers");
  EXPECT_EQ(error_of(with(kPsd + "near_left = [[2.5, 0.1], [1.3]]\n")),
            "my.toml:17: [psd] near_left must be a list of pairs of numbers");
  EXPECT_EQ(
      error_of(with(kPsd + "near_left = [[1.3, 0.1], [2.5, 0.2]]\n")),
      "my.toml:17: [psd] near_left must go from near to far, with less voltage at each point");
  EXPECT_EQ(error_of(with(kPsd + "color = 1\n")), "my.toml:17: [psd] 'color' is no key known here");
}

TEST(RobotFileGround, SensorsThatSeeNoFlatFloorAreRefused) {
  std::string high = kPsd;
  high.replace(high.find("0.1414"), 6, "0.7");
  EXPECT_EQ(error_of(with(high)),
            "my.toml:15: [psd] height and angle_deg put a flat floor 0.99 and 1.07 m ahead of the "
            "sensors; they measure from 0.10 to 0.80 m");
}

TEST(RobotFileGround, APortOrANameIsUsedOnce) {
  std::string same = kPsd;
  same.replace(same.find("/dev/psd"), 8, "/dev/roboteq");
  EXPECT_THAT(error_of(with(same)), HasSubstr("psd port /dev/roboteq is used by two devices"));
  std::string named = with(kPsd);
  named.replace(named.find("[[laser]]"), 9, "[[laser]]\nname = \"floor sensors\"");
  EXPECT_THAT(error_of(named), HasSubstr("name 'floor sensors' is used by two devices"));
}

}  // namespace
}  // namespace drivers
