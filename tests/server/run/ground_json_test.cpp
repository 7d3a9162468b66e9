// tests/server/run/ground_json_test.cpp: the ground's parameters come back from a run's document.
#include "server/run/ground_json.hpp"

#include <gtest/gtest.h>

#include "server/run/run_spec.hpp"

namespace server {
namespace {

algo::RobotSpec plain_robot() {
  algo::RobotSpec robot;
  robot.name = "plain";
  robot.radius = 0.3;
  return robot;
}

TEST(GroundJson, EverySenseComesBackBitForBit) {
  algo::RobotSpec robot = plain_robot();
  robot.axle = -0.09;
  robot.inclinometer = true;
  robot.stance = algo::Stance{0.9, 1.0 / 3.0, 0.35};
  robot.line = algo::LineCamera{0.1, 0.45, 0.123456789012345, 0.2, 0.7, 600, 640, 480};
  robot.floor = algo::FloorSensors{0.2, 0.15, 0.1, 0.785398163397448, 0.08};
  robot.climbs = algo::ClimbLimits{0.013, 0.02, 0.05, 0.17, 0.16};
  const auto document = nlohmann::json::parse(to_json(robot).dump());
  const algo::RobotSpec back = robot_spec_from_json(document);
  EXPECT_EQ(back.axle, robot.axle);
  EXPECT_TRUE(back.inclinometer);
  EXPECT_EQ(back.stance, robot.stance);
  EXPECT_EQ(back.line, robot.line);
  EXPECT_EQ(back.floor, robot.floor);
  EXPECT_EQ(back.climbs, robot.climbs);
}

TEST(GroundJson, ARobotWithoutThemHasNoneInItsDocument) {
  const nlohmann::json document = to_json(plain_robot());
  for (const char* key :
       {"axle", "inclinometer", "stance", "line_camera", "floor_sensors", "climbs"}) {
    EXPECT_FALSE(document.contains(key)) << key;
  }
  const algo::RobotSpec back = robot_spec_from_json(document);
  EXPECT_EQ(back.axle, 0);
  EXPECT_FALSE(back.inclinometer || back.stance || back.line || back.floor || back.climbs);
}

TEST(GroundJson, AnIncompleteSenseIsRefused) {
  nlohmann::json document = to_json(plain_robot());
  document["floor_sensors"] = {{"x", 0.2}};
  try {
    robot_spec_from_json(document);
    FAIL() << "was accepted";
  } catch (const DocumentError& e) {
    EXPECT_STREQ(e.what(), "robot/floor_sensors/height: is missing");
  }
}

}  // namespace
}  // namespace server
