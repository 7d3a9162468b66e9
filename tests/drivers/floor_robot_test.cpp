// tests/drivers/floor_robot_test.cpp: a real robot with floor sensors: what it observes, and when
// it stops.
#include <string>

#include "tests/drivers/fake_robot.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace drivers {
namespace {

using algo::Halt;
using ::testing::HasSubstr;

TEST(FloorRobot, DistancesAreObservedOnTheRunsClock) {
  FakeRobot f(true);
  f.step();
  ASSERT_TRUE(f.seen.floor);
  EXPECT_EQ(f.seen.floor->far_left, 0.28);
  EXPECT_EQ(f.seen.floor->near_right, 0.21);
  EXPECT_NEAR(f.seen.floor->stamp, f.seen.stamp - 0.004, 1e-9);
  f.floor->silent = true;
  f.step();
  EXPECT_FALSE(f.seen.floor) << "only new ones";
}

TEST(FloorRobot, SilenceStopsItWithinThreeReadings) {
  FakeRobot f(true);
  f.arm();
  ASSERT_TRUE(f.moves());
  f.floor->silent = true;
  const double silent_at = f.time;
  while (f.moves() && f.time < silent_at + 3) f.step();
  EXPECT_LE(f.time - kPeriod - silent_at, 3 * 0.0383 + SerialRobot::kArrivalJitter + kPeriod);
  EXPECT_EQ(f.seen.halt, Halt::FloorLost);
  EXPECT_EQ(f.robot->health().trouble, "The floor sensors at /dev/psd: It has been silent.");
  EXPECT_TRUE(f.armed());
  f.floor->silent = false;
  f.steps(0.2);
  EXPECT_TRUE(f.moves()) << "a short silence is harmless";
  f.floor->silent = true;
  f.steps(1);
  f.floor->silent = false;
  f.steps(1);
  EXPECT_FALSE(f.armed());
  EXPECT_EQ(
      f.robot->health().trouble,
      "Motors off. What happened: The floor sensors at /dev/psd: It has been silent. It is over "
      "now. Arm it again.");
}

TEST(FloorRobot, AFaultStopsItInTheTickThatDetectsItAndIsNamed) {
  FakeRobot f(true);
  f.arm();
  ASSERT_TRUE(f.moves());
  f.floor->faulty = true;
  f.step();
  EXPECT_FALSE(f.moves());
  EXPECT_EQ(f.seen.halt, Halt::FloorFault);
  EXPECT_EQ(f.robot->health().trouble,
            "The floor sensors at /dev/psd: The near left sensor is stuck.");
  f.steps(1);
  EXPECT_FALSE(f.armed());
  EXPECT_THAT(*f.robot->arm(), HasSubstr("It cannot be armed now."));
  f.floor->faulty = false;
  f.step();
  EXPECT_EQ(
      f.robot->health().trouble,
      "Motors off. What happened: The floor sensors at /dev/psd: The near left sensor is stuck. "
      "It is over now. Arm it again.");
  EXPECT_EQ(f.robot->arm(), std::nullopt);
}

TEST(FloorRobot, AFaultOfTheFloorSensorsIsNotTakenForOneOfTheScanner) {
  FakeRobot f(true);
  f.arm();
  f.floor->faulty = true;
  f.scanner->silent = true;
  f.steps(0.3);
  EXPECT_EQ(f.seen.halt, Halt::ScannerLost);
  EXPECT_EQ(f.robot->health().trouble, "The front laser at /dev/test: Silent.");
}

TEST(FloorRobot, ARobotWithoutThemHasNone) {
  FakeRobot f;
  f.arm();
  f.steps(0.5);
  EXPECT_TRUE(f.moves());
  EXPECT_FALSE(f.seen.floor);
  EXPECT_EQ(f.robot->health().devices.size(), 2U);
}

}  // namespace
}  // namespace drivers
