// tests/server/lab/climb_study_test.cpp: the limits in the robots' files are those that are
// measured.
#include "server/lab/climb/climb_study.hpp"

#include <gtest/gtest.h>

#include "server/run/robot_library.hpp"

namespace server::climb {
namespace {

constexpr double kFinest = 0.001;  // [m] the step of the measurement

class BuiltInRobot : public ::testing::TestWithParam<const char*> {};

/// The other limits take minutes to measure; `tautline climbs` prints them all.
TEST_P(BuiltInRobot, MastersTheStepOfItsFileAndNoHigherOne) {
  const sim::RobotModel robot = builtin_robot(GetParam());
  ASSERT_TRUE(robot.climbs);
  EXPECT_TRUE(masters(robot, Ground::StepUp, robot.climbs->step_up));
  EXPECT_FALSE(masters(robot, Ground::StepUp, robot.climbs->step_up + kFinest));
}

INSTANTIATE_TEST_SUITE_P(
    Climbs,
    BuiltInRobot,
    ::testing::Values("silvermate", "masuda", "jackal", "robhaz", "robhaz_tall"));

}  // namespace
}  // namespace server::climb
