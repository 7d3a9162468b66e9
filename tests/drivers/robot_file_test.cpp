// tests/drivers/robot_file_test.cpp: what a robot's file may say, and what is said about mistakes.
#include "drivers/robot_file.hpp"

#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace drivers {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string kGood = R"(name = "silvermate"
[hull]
radius = 0.35
[[laser]]
port = "/dev/lms-front"
[base]
type = "roboteq"
port = "/dev/roboteq"
track = 0.5
wheel_radius = 0.1
gear = 20
encoder_lines = 500
)";

std::string error_of(const std::string& text) {
  try {
    parse_robot(text, "my.toml");
  } catch (const RobotFileError& error) {
    return error.what();
  }
  return "";
}

std::string with(const std::string& from, const std::string& to) {
  std::string text = kGood;
  text.replace(text.find(from), from.size(), to);
  return text;
}

TEST(RobotFile, TenLinesAreEnough) {
  const RobotFile robot = parse_robot(kGood, "my.toml");
  EXPECT_EQ(robot.spec.name, "silvermate");
  EXPECT_DOUBLE_EQ(robot.spec.max_v, 0.1);
  EXPECT_DOUBLE_EQ(robot.spec.half_track, 0.25);
  EXPECT_TRUE(robot.spec.has_laser);
  EXPECT_TRUE(robot.spec.drives);
  EXPECT_FALSE(robot.spec.paceable);
  ASSERT_EQ(robot.lasers.size(), 1U);
  EXPECT_EQ(robot.lasers[0].setup.baud, 500'000U);
  EXPECT_EQ(robot.lasers[0].setup.variant, (lms200::Variant{180, 50}));
  EXPECT_THAT(robot.warnings, IsEmpty());
}

TEST(RobotFile, MistakesAreNamedWithTheirLine) {
  EXPECT_THAT(error_of("name = \"a\nb\""), HasSubstr("my.toml:1: "));
  EXPECT_EQ(error_of(with("track = 0.5", "track = \"wide\"")),
            "my.toml:9: [base] track must be a number");
  EXPECT_EQ(error_of(with("track = 0.5", "track = 50")),
            "my.toml:9: [base] track must be 0.05 to 5, not 50");
  EXPECT_EQ(error_of(with("track = 0.5", "trakc = 0.5")), "my.toml:6: [base] track is missing");
  EXPECT_EQ(error_of(with("gear = 20", "gear = 20\nshoe_size = 43")),
            "my.toml:12: [base] 'shoe_size' is no key known here");
  EXPECT_EQ(error_of(with("port = \"/dev/lms-front\"", "port = \"/dev/lms-front\"\nrate = 57600")),
            "my.toml:6: [[laser]] rate is 57600; it can be 9600, 19200, 38400, 500000");
  EXPECT_THAT(error_of(with("roboteq\"\nport", "segway\"\nport")), HasSubstr("pioneer or roboteq"));
  EXPECT_THAT(error_of(with("/dev/lms-front", "/dev/roboteq")), HasSubstr("used by two devices"));
  EXPECT_THAT(error_of("name = \"x\"\n"), HasSubstr("there is no [hull]"));
  EXPECT_THAT(error_of(with("silvermate", "Silver Mate")), HasSubstr("must be of a-z"));
}

TEST(RobotFile, AFileThatIsNotThereIsASentence) {
  EXPECT_THROW(read_robot_file("/no/such/file.toml"), RobotFileError);
}

TEST(RobotFile, CommandsHaveToComeThreeTimesWithinTheWatchdog) {
  EXPECT_THAT(error_of(with("track = 0.5", "track = 0.5\nwatchdog = 0.1")),
              HasSubstr("three times within the base's watchdog of 0.10 s"));
}

TEST(RobotFile, ALongCoastIsWarnedOf) {
  const std::string fast = with("[[laser]]", "[limits]\nspeed = 0.45\nturn = 0.2\n[[laser]]");
  EXPECT_THAT(parse_robot(fast, "my.toml").warnings, Contains(HasSubstr("0.23 m")));
}

TEST(RobotFile, MotorsThatCannotGoThatFastAreRefused) {
  EXPECT_THAT(error_of(with("gear = 20", "gear = 20\nfull_speed_rpm = 100")),
              HasSubstr("[limits] ask for"));
}

TEST(RobotFile, ALaserAheadOrSonarIsNeeded) {
  const std::string back =
      with("port = \"/dev/lms-front\"", "port = \"/dev/lms\"\nheading_deg = 180");
  EXPECT_THAT(error_of(back), HasSubstr("looks ahead"));
}

TEST(RobotFile, ThoseOfTheDocumentsAreGood) {
  const std::string folder = std::string(TAUTLINE_TESTS) + "/../docs/robots/";
  const RobotFile silvermate = read_robot_file(folder + "silvermate.toml");
  ASSERT_EQ(silvermate.lasers.size(), 2U);
  EXPECT_NEAR(std::abs(silvermate.lasers[1].mount_R.heading), std::numbers::pi, 1e-9);
  EXPECT_THAT(silvermate.warnings, IsEmpty());
  const RobotFile pioneer = read_robot_file(folder + "pioneer.toml");
  EXPECT_EQ(pioneer.base.sonar_mounts_R.size(), 16U);
  EXPECT_THAT(pioneer.warnings, IsEmpty());
}

}  // namespace
}  // namespace drivers
