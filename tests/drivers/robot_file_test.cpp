// tests/drivers/robot_file_test.cpp: valid robot files, and the sentences about mistakes.
#include "drivers/robot_file.hpp"

#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include "tests/drivers/robot_error.hpp"
#include "tests/folders.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace drivers {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
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
  ASSERT_EQ(robot.lasers.size(), 1U);
  EXPECT_EQ(robot.lasers[0].setup.baud, 500'000U);
  EXPECT_EQ(robot.lasers[0].setup.variant, (lms200::Variant{180, 50}));
  EXPECT_THAT(robot.warnings, IsEmpty());
}

TEST(RobotFile, AStickWithoutAGuardMustBeAllowed) {
  EXPECT_FALSE(parse_robot(kGood, "my.toml").spec.raw_stick);
  EXPECT_TRUE(parse_robot(with("[[laser]]", "[limits]\nraw_stick = true\n[[laser]]"), "my.toml")
                  .spec.raw_stick);
}

TEST(RobotFile, MistakesAreNamedWithTheirLine) {
  EXPECT_THAT(error_of("name = \"a\nb\""), HasSubstr("my.toml:1: "));
  EXPECT_EQ(error_of(with("track = 0.5", "track = \"wide\"")),
            "my.toml:9: [base] track must be a number");
  EXPECT_EQ(error_of(with("track = 0.5", "track = 50")),
            "my.toml:9: [base] track must be 0.05 to 1.5, not 50");
  EXPECT_EQ(error_of(with("track = 0.5", "trakc = 0.5")), "my.toml:6: [base] track is missing");
  EXPECT_EQ(error_of(with("gear = 20", "gear = 20\nshoe_size = 43")),
            "my.toml:12: [base] 'shoe_size' is no key known here");
  EXPECT_EQ(error_of(with("port = \"/dev/lms-front\"", "port = \"/dev/lms-front\"\nrate = 57600")),
            "my.toml:6: [[laser]] rate is 57600; it can be 9600, 19200, 38400, 500000");
  EXPECT_THAT(error_of(with("roboteq\"\nport", "segway\"\nport")),
              HasSubstr("pioneer, roboteq or analog"));
  EXPECT_THAT(error_of(with("/dev/lms-front", "/dev/roboteq")), HasSubstr("used by two devices"));
  EXPECT_THAT(error_of("name = \"x\"\n"), HasSubstr("there is no [hull]"));
  EXPECT_THAT(error_of(with("silvermate", "Silver Mate")), HasSubstr("must be of a-z"));
}

TEST(RobotFile, EmulatedDevicesAreOnPseudoTerminals) {
  EXPECT_TRUE(parse_robot("emulated = true\n" + kGood, "my.toml").emulated);
  const auto path = std::filesystem::path(::testing::TempDir()) / "emulated.toml";
  std::ofstream(path) << "emulated = true\n" + kGood;  // a copy with the ports of real devices
  try {
    read_robot_file(path);
    FAIL() << "it was read";
  } catch (const RobotFileError& error) {
    EXPECT_THAT(error.what(), HasSubstr("/dev/lms-front is no pseudo-terminal"));
  }
}

TEST(RobotFile, AMissingFileIsASentence) {
  EXPECT_THROW(read_robot_file("/no/such/file.toml"), RobotFileError);
}

TEST(RobotFile, WatchdogMustCoverThreePeriods) {
  EXPECT_THAT(error_of(with("track = 0.5", "track = 0.5\nwatchdog = 0.1")),
              HasSubstr("three times within the base's watchdog of 0.10 s"));
}

TEST(RobotFile, ALongCoastIsWarnedOf) {
  const std::string fast = with("[[laser]]", "[limits]\nspeed = 0.45\nturn = 0.2\n[[laser]]");
  EXPECT_THAT(parse_robot(fast, "my.toml").warnings, Contains(HasSubstr("0.23 m")));
}

TEST(RobotFile, ALongWatchdogIsWarnedOfWithItsMetresAndRefusedBeyondTwo) {
  const RobotFile slow = parse_robot(with("track = 0.5", "track = 0.5\nwatchdog = 1.5"), "my.toml");
  EXPECT_THAT(slow.warnings, Contains(AllOf(HasSubstr("my.toml:10: "), HasSubstr("0.15 m"))));
  EXPECT_THAT(parse_robot(with("track = 0.5", "track = 0.5\nwatchdog = 1.0"), "my.toml").warnings,
              IsEmpty());
  std::string fast = with("[[laser]]", "[limits]\nspeed = 0.5\nturn = 0.05\n[[laser]]");
  fast.replace(fast.find("track"), 5, "watchdog = 4.5\ntrack");
  EXPECT_THAT(error_of(fast), AllOf(HasSubstr("my.toml:12: [base] watchdog"), HasSubstr("2.25 m")));
}

TEST(RobotFile, LongBrakingIsWarnedOfWithItsMetresAndRefusedBeyondTwo) {
  // v^2 / 2a: 0.58^2 / 0.6 = 0.56 m, 0.58^2 / 0.16 = 2.10 m.
  const auto limits = [](const char* acceleration) {
    return with("[[laser]]",
                std::string("[limits]\nspeed = 0.58\nturn = 0.05\nacceleration = ") + acceleration +
                    "\n[[laser]]");
  };
  std::string text = limits("0.3");
  text.replace(text.find("gear = 20"), 9, "gear = 10");
  EXPECT_THAT(parse_robot(text, "my.toml").warnings,
              Contains(AllOf(HasSubstr("my.toml:7: "), HasSubstr("0.56 m to brake"))));
  EXPECT_THAT(error_of(limits("0.08")),
              AllOf(HasSubstr("my.toml:7: [limits] acceleration"), HasSubstr("2.10 m")));
}

TEST(RobotFile, ASlowScannerOnAFastRobotIsWarnedOf) {
  std::string text = with("port = \"/dev/lms-front\"", "port = \"/dev/lms-front\"\nrate = 9600");
  EXPECT_THAT(parse_robot(text, "my.toml").warnings, IsEmpty());  // 0.16 m in 1.6 s
  text.replace(text.find("[[laser]]"), 0, "[limits]\nspeed = 0.4\nturn = 0.05\n");
  EXPECT_THAT(parse_robot(text, "my.toml").warnings, Contains(HasSubstr("blind for up to 0.64 m")));
}

TEST(RobotFile, TheScannerStandsOnTheHull) {
  const auto at = [](const char* place) {
    return with("port = \"/dev/lms-front\"", std::string("port = \"/dev/lms-front\"\n") + place);
  };
  EXPECT_EQ(error_of(at("x = 0.35")), "");
  EXPECT_THAT(error_of(at("x = 0.36")),
              AllOf(HasSubstr("my.toml:6: [[laser]] x"), HasSubstr("outside of the hull")));
  EXPECT_THAT(error_of(at("y = -0.4")), HasSubstr("my.toml:6: [[laser]] y"));
  EXPECT_THAT(error_of(at("x = 0.3\ny = 0.3")), HasSubstr("outside of the hull"));
  std::string box = at("x = 0.3\ny = 0.3");
  box.replace(box.find("radius = 0.35"), 13, "length = 0.6\nwidth = 0.7");
  EXPECT_EQ(error_of(box), "");
}

TEST(RobotFile, WheelsStandWithinTheHull) {
  EXPECT_THAT(error_of(with("track = 0.5", "track = 2")),
              HasSubstr("my.toml:9: [base] track must be 0.05 to 1.5, not 2"));
  EXPECT_THAT(error_of(with("track = 0.5", "track = 0.8")),
              HasSubstr("my.toml:9: [base] track is 0.8 m, and the hull is 0.7 m wide"));
}

TEST(RobotFile, TheWheelsMayStandAheadOfTheHullsMiddleOrBehindIt) {
  EXPECT_EQ(parse_robot(with("track = 0.5", "track = 0.5"), "my.toml").spec.axle, 0);
  EXPECT_EQ(parse_robot(with("track = 0.5", "track = 0.5\naxle = -0.09"), "my.toml").spec.axle,
            -0.09);
  EXPECT_EQ(error_of(with("track = 0.5", "track = 0.5\naxle = 0.4")),
            "my.toml:10: [base] axle must be -0.35 to 0.35, not 0.4");
}

TEST(RobotFile, QuarterDegreesNeedAFastLine) {
  const auto laser = [](const char* keys) {
    return with("port = \"/dev/lms-front\"", std::string("port = \"/dev/lms-front\"\n") + keys);
  };
  EXPECT_EQ(error_of(laser("step_deg = 0.25")), "");
  EXPECT_EQ(error_of(laser("step_deg = 0.25\nrate = 38400\nangle_deg = 100")), "");
  EXPECT_THAT(error_of(laser("rate = 38400\nstep_deg = 0.25")),
              AllOf(HasSubstr("my.toml:7: [[laser]] step_deg"), HasSubstr("38400 bit/s")));
}

TEST(RobotFile, LimitsBeyondTheBaseAreRefused) {
  EXPECT_THAT(error_of(with("encoder_lines = 500", "encoder_lines = 1\nfull_speed_rpm = 60000")),
              HasSubstr("too coarse"));
  EXPECT_THAT(error_of(with("gear = 20\nencoder_lines = 500",
                            "gear = 1\nencoder_lines = 1\nfull_speed_rpm = 60")),
              HasSubstr("my.toml:12: [base] encoder_lines makes one count"));
  EXPECT_THAT(error_of(with("[[laser]]", "[limits]\nacceleration = 5\nspeed = 0.02\n[[laser]]")),
              "");
  std::string ramp = with("[[laser]]", "[limits]\nacceleration = 5\nspeed = 0.02\n[[laser]]");
  ramp.replace(ramp.find("gear = 20"), 9, "gear = 900\nfull_speed_rpm = 65000");
  EXPECT_THAT(error_of(ramp), HasSubstr("[base] gear makes a ramp"));
  EXPECT_THAT(error_of("name = \"a\"\nhull = { radius = 0.3 }\nlimits = { turn = 0.015 }\n[base]\n"
                       "type = \"pioneer\"\nport = \"/dev/p\"\ntrack = 0.3\n"),
              HasSubstr("my.toml:5: [base] type is pioneer, which turns by whole degrees"));
}

TEST(RobotFile, NamesTheControllerOutsideTheProgramThatMayDrive) {
  EXPECT_EQ(parse_robot(kGood, "my.toml").external_controller, "");
  EXPECT_EQ(parse_robot("external_controller = \"mine\"\n" + kGood, "my.toml").external_controller,
            "mine");
}

TEST(RobotFile, InvalidNamesAndPortsAreRefused) {
  EXPECT_THAT(error_of("controller = \"best\"\n" + kGood),
              AllOf(HasSubstr("my.toml:1: controller is 'best'"), HasSubstr("modified")));
  EXPECT_THAT(error_of("filter = \"best\"\n" + kGood), HasSubstr("my.toml:1: filter is 'best'"));
  EXPECT_THAT(error_of(with("/dev/roboteq", "tcp:host")), HasSubstr("my.toml:8: [base] port"));
  EXPECT_EQ(error_of(with("/dev/roboteq", "tcp:host:8101")), "");
  const std::string password = "port = \"/dev/lms-front\"\npassword = ";
  EXPECT_THAT(error_of(with("port = \"/dev/lms-front\"", password + "\"SHORT\"")),
              HasSubstr("my.toml:6: [[laser]] password must have 8 characters"));
  EXPECT_EQ(error_of(with("port = \"/dev/lms-front\"", password + "\"LONGPASS\"")), "");
}

TEST(RobotFile, MotorsSlowerThanTheLimitsAreRefused) {
  EXPECT_THAT(error_of(with("gear = 20", "gear = 20\nfull_speed_rpm = 100")),
              HasSubstr("[limits] ask for"));
}

TEST(RobotFile, ALaserAheadOrSonarIsNeeded) {
  const std::string back =
      with("port = \"/dev/lms-front\"", "port = \"/dev/lms\"\nheading_deg = 180");
  EXPECT_THAT(error_of(back), HasSubstr("looks ahead"));
}

TEST(RobotFile, ExamplesInTheDocumentsAreValid) {
  const std::string folder = (tests::folder().parent_path() / "docs/robots/").string();
  const RobotFile silvermate = read_robot_file(folder + "silvermate.toml");
  ASSERT_EQ(silvermate.lasers.size(), 2U);
  EXPECT_NEAR(std::abs(silvermate.lasers[1].mount_R.heading), std::numbers::pi, 1e-9);
  EXPECT_THAT(silvermate.warnings, IsEmpty());
  const RobotFile pioneer = read_robot_file(folder + "pioneer.toml");
  EXPECT_EQ(pioneer.base.sonar_mounts_R.size(), 16U);
  // The watchdog in the base's memory cannot be set from here.
  EXPECT_THAT(pioneer.warnings, ElementsAre(HasSubstr("0.20 m before its own watchdog")));
}

}  // namespace
}  // namespace drivers
