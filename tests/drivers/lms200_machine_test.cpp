// tests/drivers/lms200_machine_test.cpp: finding, setting up, reading and leaving a scanner.
#include "drivers/lms200_machine.hpp"

#include "tests/drivers/fake_lms200.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace drivers::lms200 {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct Fixture {
  explicit Fixture(const LaserSetup& setup = {}) : machine(setup), bench(machine, device) {}
  Fixture(const Fixture&) = delete;
  Fixture& operator=(const Fixture&) = delete;

  bool running(double seconds) {
    return bench.run_until(seconds, [&] { return machine.stage() == Stage::Running; });
  }
  bool scan(algo::LaserScan& into, double seconds = 5) {
    return bench.run_until(seconds, [&] { return machine.take(into); });
  }
  FakeLms200 device{};
  LaserMachine machine;
  LineBench bench;
};

TEST(Lms200Machine, FactoryFreshDeviceIsFoundAndSetUp) {
  Fixture f;
  f.bench.open();
  ASSERT_TRUE(f.running(10));
  algo::LaserScan scan;
  ASSERT_TRUE(f.scan(scan));
  EXPECT_EQ(f.device.baud, 500'000U);
  EXPECT_EQ(f.device.variant, (Variant{180, 50}));
  EXPECT_EQ(scan.size(), 361U);
  EXPECT_DOUBLE_EQ(scan.ranges[100], 1.234);
  EXPECT_EQ(f.device.writes, 1);  // it was in centimetres
  EXPECT_EQ(f.device.resets, 0);
  const LaserReport report = f.machine.report();
  EXPECT_EQ(report.baud, 500'000U);
  EXPECT_EQ(report.type, "LMS200;301063;V02.30");
  EXPECT_EQ(report.software, "V02.30");
  EXPECT_THAT(report.remarks, IsEmpty());
  EXPECT_EQ(report.trouble, "");
}

TEST(Lms200Machine, MatchingConfigurationIsNotWritten) {
  Fixture f;
  f.device.block[6] = 1;
  f.bench.open();
  ASSERT_TRUE(f.running(10));
  EXPECT_EQ(f.device.writes, 0);
}

TEST(Lms200Machine, MeasuringModeOfTheSameRangeIsKept) {
  LaserSetup setup;
  setup.range = 16;
  Fixture f(setup);
  f.device.block[5] = 0x03;  // 16 m too, with other upper bits
  f.device.block[6] = 1;
  f.bench.open();
  ASSERT_TRUE(f.running(10));
  EXPECT_EQ(f.device.writes, 0);
  EXPECT_EQ(f.device.block[5], 0x03);
}

TEST(Lms200Machine, RangeChoosesModeAndUnit) {
  for (const auto& [range, mode, unit] :
       {std::tuple{16U, 0x04, 1}, {32U, 0x06, 1}, {80U, 0x00, 0}}) {
    LaserSetup setup;
    setup.range = range;
    Fixture f(setup);
    f.bench.open();
    ASSERT_TRUE(f.running(10));
    EXPECT_EQ(f.device.block[5], mode);
    EXPECT_EQ(f.device.block[6], unit);
    algo::LaserScan scan;
    ASSERT_TRUE(f.scan(scan));
    EXPECT_DOUBLE_EQ(scan.ranges[0], unit == 1 ? 1.234 : 12.34);
  }
}

TEST(Lms200Machine, DeviceLeftStreamingAtTheWantedRateRunsWithinASecond) {
  Fixture f;
  f.device.baud = 500'000;
  f.device.streams = true;
  f.device.variant = {180, 50};
  f.device.block[6] = 1;
  f.bench.open();
  EXPECT_TRUE(f.running(1));
}

TEST(Lms200Machine, DeviceIsFoundAtEveryRate) {
  for (const unsigned rate : {9600U, 19200U, 38400U, 500'000U}) {
    Fixture f;
    f.device.baud = rate;
    f.device.streams = true;
    f.bench.open();
    EXPECT_TRUE(f.running(15)) << rate;
    EXPECT_EQ(f.device.baud, 500'000U);
  }
}

TEST(Lms200Machine, AnswersFromAddressOneAreAccepted) {
  Fixture f;
  f.device.address = 1;
  f.bench.open();
  ASSERT_TRUE(f.running(10));
  EXPECT_EQ(f.machine.report().address, 1);
}

TEST(Lms200Machine, LatePowerOnIsWaitedFor) {
  Fixture f;
  f.device.boots_until = f.bench.now() + 55;
  f.bench.open();
  f.bench.run(30);
  EXPECT_THAT(f.machine.report().trouble, HasSubstr("waiting for power-on"));
  EXPECT_TRUE(f.running(40));
}

TEST(Lms200Machine, DeviceThatNeverAnswersIsReported) {
  Fixture f;
  f.device.dead = true;
  f.bench.open();
  f.bench.run(80);
  EXPECT_NE(f.machine.stage(), Stage::Running);
  EXPECT_THAT(f.machine.report().trouble, HasSubstr("Is it powered"));
}

TEST(Lms200Machine, RestartInOperationIsSetUpAgain) {
  Fixture f;
  f.bench.open();
  ASSERT_TRUE(f.running(10));
  f.device.restart(f.bench.now(), 9);
  ASSERT_TRUE(f.bench.run_until(5, [&] { return f.machine.stage() != Stage::Running; }));
  ASSERT_TRUE(f.running(30));
  EXPECT_EQ(f.machine.report().set_ups, 2U);
  EXPECT_EQ(f.device.baud, 500'000U);
  EXPECT_EQ(f.device.writes, 1);  // once, when it was new
}

TEST(Lms200Machine, GreetingAtItsOwnRateRestartsAtOnce) {
  LaserSetup setup;
  setup.baud = 9600;
  Fixture f(setup);
  f.bench.open();
  ASSERT_TRUE(f.running(10));
  f.device.restart(f.bench.now(), 0.3);
  ASSERT_TRUE(f.bench.run_until(5, [&] { return f.machine.report().set_ups == 2; }));
}

TEST(Lms200Machine, PortWithoutTheRateFallsBackWithARemark) {
  Fixture f;
  f.bench.port = [](unsigned wanted) { return wanted == 500'000 ? 460'800U : wanted; };
  f.bench.open();
  ASSERT_TRUE(f.running(15));
  EXPECT_EQ(f.device.baud, 38400U);
  EXPECT_THAT(f.machine.report().remarks, Contains(HasSubstr("4 to 5 scans a second")));
  algo::LaserScan scan;
  EXPECT_TRUE(f.scan(scan));
}

TEST(Lms200Machine, RefusedVariantKeepsTheDevicesOwn) {
  Fixture f;
  f.device.refuses_variant = true;
  f.bench.open();
  ASSERT_TRUE(f.running(10));
  algo::LaserScan scan;
  ASSERT_TRUE(f.scan(scan));
  EXPECT_EQ(scan.size(), 181U);
  EXPECT_THAT(f.machine.report().remarks, Contains(HasSubstr("does not take 180 degrees")));
}

TEST(Lms200Machine, WrongPasswordLeavesTheConfigurationAlone) {
  Fixture f;
  f.device.wrong_password = true;
  f.bench.open();
  ASSERT_TRUE(f.running(10));
  EXPECT_EQ(f.device.writes, 0);
  EXPECT_THAT(f.machine.report().remarks, Contains(HasSubstr("cannot be read")));
}

TEST(Lms200Machine, QuarterDegreesComeInterlaced) {
  LaserSetup setup;
  setup.variant = {180, 25};
  Fixture f(setup);
  f.bench.open();
  ASSERT_TRUE(f.running(10));
  algo::LaserScan scan;
  ASSERT_TRUE(f.scan(scan));
  EXPECT_EQ(scan.size(), 721U);
  EXPECT_EQ(scan.turns, 4U);
  EXPECT_DOUBLE_EQ(scan.ranges[3], 1.237);  // of the fourth part
}

TEST(Lms200Machine, StampIsTheEndOfTheSweepNotItsArrival) {
  for (const unsigned baud : {38400U, 500'000U}) {
    LaserSetup setup;
    setup.baud = baud;
    Fixture f(setup);
    f.bench.open();
    ASSERT_TRUE(f.running(10));
    algo::LaserScan scan;
    ASSERT_TRUE(f.scan(scan));
    const double transfer = 732 * 10.0 / baud;
    EXPECT_NEAR(scan.stamp, f.bench.now() - transfer, 0.002) << baud;
  }
}

TEST(Lms200Machine, PeriodIsMeasured) {
  Fixture f;
  f.bench.open();
  ASSERT_TRUE(f.running(10));
  f.bench.run(5);
  EXPECT_NEAR(f.machine.scan_period(), 2 * kTurnPeriod, 0.001);
}

TEST(Lms200Machine, BunchedScansDoNotRaiseTheScanRate) {
  Fixture f;
  f.bench.open();
  ASSERT_TRUE(f.running(10));
  f.bench.bunch = 0.12;
  f.bench.run(20);
  EXPECT_GE(f.machine.scan_period(), 0.9 * 2 * kTurnPeriod);
  f.bench.bunch = 0;
  f.bench.run(5);
  EXPECT_NEAR(f.machine.scan_period(), 2 * kTurnPeriod, 0.001);
}

TEST(Lms200Machine, UpsideDownIsTurnedRound) {
  LaserSetup setup;
  setup.upside_down = true;
  setup.variant = {180, 25};
  Fixture f(setup);
  f.bench.open();
  ASSERT_TRUE(f.running(10));
  algo::LaserScan scan;
  ASSERT_TRUE(f.scan(scan));
  EXPECT_DOUBLE_EQ(scan.ranges[717], 1.237);
}

TEST(Lms200Machine, ScansMarkedUnreliableAreNotDelivered) {
  Fixture f;
  f.bench.open();
  ASSERT_TRUE(f.running(10));
  f.device.status = 0x13;  // error
  f.bench.run(0.1);
  algo::LaserScan scan;
  while (f.machine.take(scan)) {
  }
  f.bench.run(0.5);
  EXPECT_FALSE(f.machine.take(scan));
  EXPECT_FALSE(f.machine.health().usable());
  EXPECT_EQ(f.machine.stage(), Stage::Running);
  f.device.status = 0x10;
  EXPECT_TRUE(f.scan(scan));
}

TEST(Lms200Machine, StormOfDamagedTelegramsIsReported) {
  Fixture f;
  f.bench.open();
  ASSERT_TRUE(f.running(10));
  f.bench.run(2);
  EXPECT_LT(f.machine.damaged(), 0.1);
  f.device.damages = true;  // three of four
  f.bench.run(4);
  EXPECT_GT(f.machine.damaged(), 0.5);
  EXPECT_TRUE(f.machine.storm());
  f.device.damages = false;
  f.bench.run(2);
  EXPECT_LT(f.machine.damaged(), 0.1);
  EXPECT_FALSE(f.machine.storm());
}

TEST(Lms200Machine, StormEndsOnlyWhenTheLineIsGood) {
  Fixture f;
  f.bench.open();
  ASSERT_TRUE(f.running(10));
  f.device.damages = true;
  ASSERT_TRUE(f.bench.run_until(10, [&] { return f.machine.storm(); }));
  f.device.damages = false;
  ASSERT_TRUE(f.bench.run_until(5, [&] { return f.machine.damaged() < 0.4; }));
  EXPECT_TRUE(f.machine.storm());
  f.bench.unplug();
  f.bench.open();
  ASSERT_TRUE(f.running(10));
  EXPECT_TRUE(f.machine.storm() ||
              f.machine.damaged() < 0.1);  // set up anew is not yet a good line
  EXPECT_TRUE(f.bench.run_until(10, [&] { return !f.machine.storm(); }));
}

TEST(Lms200Machine, DeviceIsLeftInItsInitialState) {
  Fixture f;
  f.bench.open();
  ASSERT_TRUE(f.running(10));
  f.machine.leave(f.bench.now());
  f.bench.settle();
  ASSERT_TRUE(f.bench.run_until(3, [&] { return f.machine.left(); }));
  EXPECT_EQ(f.device.baud, 9600U);
  EXPECT_FALSE(f.device.streams);
}

TEST(Lms200Machine, UnpluggedAndPluggedInAgain) {
  Fixture f;
  f.bench.open();
  ASSERT_TRUE(f.running(10));
  f.bench.unplug();
  EXPECT_EQ(f.machine.stage(), Stage::NoLine);
  EXPECT_THAT(f.machine.report().trouble, HasSubstr("has gone"));
  f.bench.open();
  EXPECT_TRUE(f.running(10));
}

}  // namespace
}  // namespace drivers::lms200
