// tests/drivers/lms200_set_up_test.cpp: slow, deaf, faulty and dazzled scanners: each set-up ends
// in scans or in the right sentence, and each device is left as it was found.
#include <numbers>

#include "tests/drivers/emulated_laser.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/lms200_device.hpp"

namespace drivers {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Leaves the device; false when that takes longer than a program waits.
bool leaves(Laser& laser) {
  laser.machine.leave(laser.bench.now());
  laser.bench.settle();
  const bool left = laser.bench.run_until(8, [&] { return laser.machine.left(); });
  laser.bench.run(0.2);
  return left;
}

TEST(Lms200SetUp, SetUpSucceedsWithModeSwitchesOfThreeSeconds) {
  for (const unsigned found : {9600U, 38400U, 500'000U}) {
    lms200::EmulatorOptions options;
    options.times.mode = 3.0;
    options.start_rate = found;
    Laser laser(options);
    ASSERT_TRUE(laser.running(40)) << found << laser.machine.report().trouble;
    laser.expect_room(361);
    EXPECT_THAT(laser.machine.report().remarks, IsEmpty());
    EXPECT_TRUE(leaves(laser));
    EXPECT_EQ(laser.emulator.baud(), found);
    EXPECT_EQ(laser.emulator.mode(), lms200::Mode::OnRequest);
  }
}

TEST(Lms200SetUp, SetUpSucceedsWithTwoDeafSecondsAfterSwitchesAndPowerOn) {
  for (const double mode : {0.06, 3.0}) {
    lms200::EmulatorOptions options;
    options.powered = false;
    options.times.mode = mode;
    options.times.deaf = 2.0;
    Laser laser(options);
    ASSERT_TRUE(laser.running(60)) << mode << laser.machine.report().trouble;
    laser.expect_room(361);
    EXPECT_THAT(laser.machine.report().remarks, IsEmpty());
    EXPECT_EQ(laser.machine.report().baud, 500'000U);
    EXPECT_EQ(laser.machine.report().set_ups, 1U);
  }
}

TEST(Lms200SetUp, ADeafDeviceIsLeftAtTheRateItWasFoundAt) {
  for (const unsigned found : {9600U, 38400U, 500'000U}) {
    lms200::EmulatorOptions options;
    options.times.deaf = 2.0;
    options.start_rate = found;
    Laser laser(options);
    ASSERT_TRUE(laser.running(60)) << found << laser.machine.report().trouble;
    EXPECT_TRUE(leaves(laser));
    EXPECT_EQ(laser.emulator.baud(), found);
    EXPECT_EQ(laser.emulator.mode(), lms200::Mode::OnRequest);
  }
}

TEST(Lms200SetUp, SlowDeviceLeftStreamingIsFoundAgain) {
  lms200::EmulatorOptions options;
  options.times.mode = 3.0;
  options.times.deaf = 2.0;
  Laser laser(options);
  ASSERT_TRUE(laser.running(60));
  laser.machine.closed(laser.bench.now(), "Gone.");
  laser.bench.open();
  ASSERT_TRUE(laser.running(60)) << laser.machine.report().trouble;
  laser.expect_room(361);
}

TEST(Lms200SetUp, ADeviceThatAnswersOnlyNakIsReported) {
  lms200::EmulatorOptions options;
  options.refusals = 1'000'000;
  Laser laser(options);
  EXPECT_FALSE(laser.running(20));
  EXPECT_THAT(laser.machine.report().trouble,
              AllOf(HasSubstr("answers at 9600 bit/s"), HasSubstr("NAK")));
  laser.emulator.refuse_next(0);
  EXPECT_TRUE(laser.running(20));
}

TEST(Lms200SetUp, ADeviceThatStartsToAnswerOnlyNakIsReported) {
  Laser laser({});
  ASSERT_TRUE(laser.bench.run_until(10, [&] { return !laser.machine.report().type.empty(); }));
  laser.emulator.refuse_next(1'000'000);
  EXPECT_FALSE(laser.running(40));
  EXPECT_THAT(laser.machine.report().trouble, HasSubstr("NAK"));
}

TEST(Lms200SetUp, AnInspectedDeviceKeepsItsRateAndConfiguration) {
  for (const unsigned found : {9600U, 19200U, 38400U, 500'000U}) {
    lms200::EmulatorOptions options;
    options.start_rate = found;
    lms200::LaserSetup look;
    look.as_it_is = true;
    Laser laser(options, look);
    ASSERT_TRUE(laser.running(20)) << found;
    EXPECT_EQ(laser.machine.report().baud, found);
    EXPECT_EQ(laser.machine.report().variant, options.variant);
    EXPECT_TRUE(leaves(laser));
    EXPECT_EQ(laser.emulator.baud(), found);
    EXPECT_EQ(laser.emulator.mode(), lms200::Mode::OnRequest);
    EXPECT_EQ(laser.emulator.memory_writes(), 0U);
  }
}

TEST(Lms200SetUp, ADeviceThatRestartedIsLeftAtItsOwnRate) {
  lms200::EmulatorOptions options;
  options.start_rate = 38400;
  Laser laser(options);
  ASSERT_TRUE(laser.running(20));
  laser.emulator.restart(laser.bench.now(), 2);
  ASSERT_TRUE(laser.bench.run_until(30, [&] { return laser.machine.report().set_ups == 2; }));
  EXPECT_TRUE(leaves(laser));
  EXPECT_EQ(laser.emulator.baud(), 38400U);
}

TEST(Lms200SetUp, AnUnknownPasswordIsReportedAndAGivenOneIsUsed) {
  lms200::EmulatorOptions options;
  options.password = "MOBILE_1";
  Laser stranger(options);
  ASSERT_TRUE(stranger.running(20));
  EXPECT_THAT(stranger.machine.report().remarks, Contains(HasSubstr("--password")));
  stranger.expect_room(361);

  lms200::LaserSetup knows = setup(500'000);
  knows.password = "MOBILE_1";
  knows.range = 32;
  Laser owner(options, knows);
  ASSERT_TRUE(owner.running(20));
  EXPECT_THAT(owner.machine.report().remarks, IsEmpty());
  EXPECT_EQ(owner.emulator.configuration().measuring_mode(), 0x06);
}

TEST(Lms200SetUp, AnRs232LineFallsBackToHalfDegrees) {
  lms200::EmulatorOptions options;
  options.rs422 = false;
  Laser laser(options, setup(500'000, {180, 25}));
  ASSERT_TRUE(laser.running(20));
  EXPECT_EQ(laser.emulator.baud(), 38400U);
  EXPECT_THAT(laser.machine.report().remarks, Contains(HasSubstr("half degrees")));
  EXPECT_THAT(laser.machine.report().remarks, Contains(HasSubstr("4 to 5 scans a second")));
  laser.expect_room(361);
}

TEST(Lms200Report, ADazzledScannerIsReported) {
  Laser laser({});
  ASSERT_TRUE(laser.running(20));
  laser.bench.run(0.2);
  const auto report = [&] { return describe(laser.machine.report(), laser.bench.now()); };
  EXPECT_TRUE(report().well) << report().sentence;
  laser.emulator.dazzle(true);
  laser.bench.run(0.2);
  EXPECT_TRUE(laser.machine.blinded());
  EXPECT_FALSE(report().well);
  EXPECT_THAT(report().sentence, HasSubstr("blinded"));
  laser.emulator.dazzle(true, 20.5 * std::numbers::pi / 180);
  laser.bench.run(0.2);
  EXPECT_FALSE(laser.machine.blinded());
  EXPECT_FALSE(report().well);
  EXPECT_THAT(report().sentence, HasSubstr("dazzled from -10 to 10 degrees"));
  laser.emulator.dazzle(false);
  laser.bench.run(0.2);
  EXPECT_TRUE(report().well);
}

}  // namespace
}  // namespace drivers
