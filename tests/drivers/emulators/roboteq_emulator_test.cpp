// tests/drivers/emulators/roboteq_emulator_test.cpp: the emulated Roboteq controller, line by line.
#include "drivers/emulators/roboteq_emulator.hpp"

#include <limits>
#include <numbers>

#include "tests/drivers/emulators/talk.hpp"
#include "tests/drivers/hex.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/roboteq_protocol.hpp"

namespace drivers::roboteq {
namespace {

using emulators::Host;
using emulators::WheelMotion;
using ::testing::HasSubstr;

/// A controller with echo off, and wheels that follow it exactly.
class Driven {
 public:
  explicit Driven(const EmulatorOptions& options = {}) : device(options), host(device) {
    say("^ECHOF 1\r");
  }

  std::string say(const std::string& line) { return emulators::text(host.ask(line, 0.05)); }
  std::string drive(double seconds) {
    std::string got;
    for (int i = 0; i < static_cast<int>(seconds / kStep + 0.5); ++i) {
      senses.motion = device.drive(host.now());
      senses.left_travel += senses.motion.left * kStep;
      senses.right_travel += senses.motion.right * kStep;
      device.feel(senses, host.now());
      got += emulators::text(host.listen(kStep));
    }
    return got;
  }

  static constexpr double kStep = 0.005;
  Emulator device;
  Host host;
  emulators::BaseSenses senses{};
};

EmulatorOptions with_200_rpm() {
  EmulatorOptions options;
  options.full_speed_rpm = 200;
  return options;
}

TEST(RoboteqEmulator, AnswersMatchTheVectors) {
  Emulator device(with_200_rpm());
  Host host(device);
  EXPECT_EQ(emulators::text(host.ask(std::string("^ECHOF 1\r"), 0.1)), "^ECHOF 1\r+\r");
  Driven base(with_200_rpm());
  EXPECT_EQ(base.say("?FID\r"), "FID=Roboteq v2.0 SDC2XXX 01/01/2020\r");
  EXPECT_EQ(base.say("^RWD 500\r"), "+\r");
  EXPECT_EQ(base.say("~RWD\r"), "RWD=500\r");
  EXPECT_EQ(base.say("!G 1 500_!G 2 -250\r"), "+\r+\r");
  base.drive(0.4);
  EXPECT_EQ(base.say("?S\r"), "S=100:-50\r");
  EXPECT_EQ(base.say("?V\r"), "V=120:240:5010\r");
  EXPECT_EQ(base.say("?V 2\r"), "V=240\r");
  EXPECT_EQ(base.say("!EX\r"), "+\r");
  EXPECT_EQ(base.say("?FF\r"), "FF=16\r");
  EXPECT_EQ(base.say("?FS\r"), "FS=9\r");
  EXPECT_EQ(base.say("!QQ 1\r"), "-\r");
  EXPECT_EQ(emulators::text(base.host.ask(hex("05"), 0.05)), "\x06");
}

TEST(RoboteqEmulator, RepeatsItsQueriesInTurn) {
  Driven base;
  std::string got = base.say("# C_?C_?FF_# 50\r");
  got += base.drive(0.18);
  EXPECT_EQ(got, "C=0:0\rFF=0\rC=0:0\rFF=0\rC=0:0\rFF=0\r");
  base.say("#\r");
  EXPECT_EQ(base.drive(0.5), "");
}

TEST(RoboteqEmulator, CountersWrapAround) {
  EmulatorOptions options;
  options.first_count = std::numeric_limits<std::int32_t>::max() - 10;
  options.wheel_radius = 1 / (2 * std::numbers::pi);
  options.gear = 1;
  options.encoder_lines = 25;  // a hundred counts a turn, which is a metre
  Driven base(options);
  base.device.feel(base.senses, base.host.now());
  EXPECT_EQ(base.say("?C\r"), "C=2147483637:2147483637\r");
  base.senses.left_travel = 1;
  base.senses.right_travel = -1;
  base.device.feel(base.senses, base.host.now());
  EXPECT_EQ(base.say("?C\r"), "C=-2147483559:2147483537\r");
  EXPECT_EQ(base.say("!C 1 0_!C 2 5\r"), "+\r+\r");
  EXPECT_EQ(base.say("?C\r"), "C=0:5\r");
  base.senses.left_travel = 1.5;
  base.device.feel(base.senses, base.host.now());
  EXPECT_EQ(base.say("?CR\r"), "CR=50:0\r");
  EXPECT_EQ(base.say("?CR 1\r"), "CR=0\r");
}

TEST(RoboteqEmulator, TheWatchdogStopsMotorsWithoutCommands) {
  Driven base;
  std::vector<emulators::BaseCommand> commands;
  base.device.on_command = [&](const emulators::BaseCommand& c) { commands.push_back(c); };
  base.say("^RWD 300\r");
  base.say("!G 1 100_!G 2 100\r");
  base.drive(0.2);
  EXPECT_GT(base.senses.motion.left, 0.01);
  base.say("?S\r");  // a query does not feed it
  base.drive(0.3);
  EXPECT_EQ(base.senses.motion.left, 0);
  EXPECT_EQ(commands.back().wanted, WheelMotion{});
  base.say("!G 1 100\r");
  base.drive(0.2);
  EXPECT_GT(base.senses.motion.left, 0.01);
}

TEST(RoboteqEmulator, EmergencyStopDiscardsTheCommand) {
  Driven base;
  base.say("!G 1 100_!G 2 100\r");
  base.drive(0.2);
  base.say("!EX\r");
  base.say("!G 1 100\r");
  base.drive(0.3);
  EXPECT_EQ(base.senses.motion.left, 0);
  base.say("!MG\r");
  base.drive(0.3);
  EXPECT_EQ(base.senses.motion.left, 0);
  base.say("!G 1 100\r");
  base.drive(0.3);
  EXPECT_GT(base.senses.motion.left, 0);
}

TEST(RoboteqEmulator, TheStopButtonHoldsUntilReleasedAndReset) {
  Driven base;
  base.say("!G 1 100\r");
  base.drive(0.2);
  base.device.press_stop_button(true);
  base.drive(0.2);
  EXPECT_EQ(base.senses.motion.left, 0);
  base.say("!MG\r");
  EXPECT_EQ(base.say("?FF\r"), "FF=16\r");
  base.device.press_stop_button(false);
  EXPECT_EQ(base.say("?FF\r"), "FF=16\r");
  base.say("!MG\r");
  EXPECT_EQ(base.say("?FF\r"), "FF=0\r");
}

TEST(RoboteqEmulator, ParametersAreCheckedAndLastUntilPowerOffUnlessStored) {
  Driven base;
  EXPECT_EQ(base.say("^MXRPM 1 0\r"), "-\r");
  EXPECT_EQ(base.say("^MXRPM 3 100\r"), "-\r");
  EXPECT_EQ(base.say("^MMOD 1 2\r"), "-\r");
  EXPECT_EQ(base.say("^MXRPM 1 300\r"), "+\r");
  EXPECT_EQ(base.say("~MXRPM\r"), "MXRPM=300:1000\r");
  EXPECT_EQ(base.say("~MXRPM 1\r"), "MXRPM=300\r");
  EXPECT_EQ(base.say("^MMOD 1 0\r"), "+\r");
  EXPECT_EQ(base.say("!S 1 50\r"), "-\r");  // no speed without a loop
  EXPECT_EQ(base.say("%RESET 321654987\r"), "+\r");
  base.drive(1.1);
  EXPECT_TRUE(base.device.echoes());
  base.say("^ECHOF 1\r");
  EXPECT_EQ(base.say("~MXRPM\r"), "MXRPM=1000:1000\r");
  base.say("^MXRPM 1 300\r");
  EXPECT_EQ(base.say("%EESAV\r"), "+\r");
  EXPECT_EQ(base.device.memory_writes(), 1U);
  base.device.restart(base.host.now(), 0.1);
  base.drive(0.2);
  EXPECT_THAT(base.say("~MXRPM 1\r"), HasSubstr("MXRPM=300"));
}

TEST(RoboteqEmulator, BatteryBumperAndFaults) {
  Driven base;
  base.device.set_battery(18);
  EXPECT_EQ(base.say("?V 2\r"), "V=180\r");
  EXPECT_EQ(base.say("?FF\r"), "FF=4\r");
  base.device.set_battery(24);
  base.device.set_faults_reported(8);
  EXPECT_EQ(base.say("?FF\r"), "FF=8\r");
  base.device.set_faults_reported(0);
  base.device.press_bumper(true);
  EXPECT_EQ(base.say("?DI 1\r"), "DI=1\r");
}

TEST(RoboteqEmulator, OneChannelShowsOneValue) {
  EmulatorOptions options;
  options.one_channel = true;
  Driven base(options);
  EXPECT_EQ(base.say("?C\r"), "C=0\r");
  EXPECT_EQ(base.say("!G 2 100\r"), "-\r");
}

}  // namespace
}  // namespace drivers::roboteq
