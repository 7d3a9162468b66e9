// tests/drivers/psd_machine_test.cpp: the machine of the floor sensors against the emulated adapter
// on a line with faults.
#include "drivers/psd_machine.hpp"

#include <cmath>
#include <limits>
#include <string>

#include "tests/drivers/emulated_laser.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/emulators/psd_emulator.hpp"

namespace drivers::psd {
namespace {

using ::testing::HasSubstr;

constexpr double kNothing = std::numeric_limits<double>::infinity();

struct Bench {
  explicit Bench(const EmulatorOptions& options = {}, const PsdSetup& setup = {})
      : emulator(options), device(emulator), machine(setup), line(machine, device) {
    emulator.sense({0.28, 0.28, 0.2, 0.2});
    line.open();
  }
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;

  bool well() { return machine.report(line.now()).well; }
  bool faulty() { return machine.state(line.now()).faulty; }
  std::string sentence() { return machine.report(line.now()).sentence; }
  /// [s] from now until the machine is faulty; infinity if it is not within `seconds`.
  double faulty_after(double seconds) {
    const double begun = line.now();
    return line.run_until(seconds, [&] { return faulty(); }) ? line.now() - begun : kNothing;
  }

  Emulator emulator;
  Emulated device;
  PsdMachine machine;
  LineBench line;
};

TEST(PsdMachine, DistancesArriveWithTheirTime) {
  Bench bench({.noise = 0.0005});
  bench.emulator.sense({0.3, 0.25, kNothing, 0.15});
  bench.line.run(1);
  algo::FloorRanges ranges;
  while (bench.machine.take(ranges)) {
  }
  ASSERT_TRUE(bench.line.run_until(0.1, [&] { return bench.machine.take(ranges); }));
  EXPECT_NEAR(ranges.far_left, 0.3, 0.002);
  EXPECT_NEAR(ranges.far_right, 0.25, 0.002);
  EXPECT_TRUE(std::isnan(ranges.near_left));
  EXPECT_NEAR(ranges.near_right, 0.15, 0.002);
  EXPECT_NEAR(ranges.stamp, bench.line.now() - 42 * 10 / 115200.0, 0.003);
  EXPECT_FALSE(bench.machine.take(ranges)) << "only once";
  EXPECT_TRUE(bench.well()) << bench.sentence();
}

TEST(PsdMachine, ReadingsComeAtTheSensorsRate) {
  for (const unsigned baud : {19200U, 115'200U}) {
    PsdSetup setup;
    setup.baud = baud;
    Bench bench({.baud = baud}, setup);
    bench.line.run(10);
    EXPECT_NEAR(static_cast<double>(bench.machine.readings()), 10 / kPeriod, 2);
    EXPECT_TRUE(bench.well()) << bench.sentence();
  }
}

/// The folded part of the curve cannot be told from the far one; only what is beyond 2.45 V can.
TEST(PsdMachine, ASurfaceTooNearIsNoReading) {
  Bench bench;
  bench.emulator.sense({0.08, 0.085, 0.2, 0.2});
  bench.line.run(0.2);
  algo::FloorRanges ranges;
  ASSERT_TRUE(bench.machine.take(ranges));
  EXPECT_TRUE(std::isnan(ranges.far_left));
  EXPECT_TRUE(std::isnan(ranges.far_right));
}

TEST(PsdMachine, ALongQuietDriveGivesNoAlarm) {
  Bench bench;
  EXPECT_EQ(bench.faulty_after(600), kNothing) << bench.sentence();
}

TEST(PsdMachine, SilenceIsSaid) {
  Bench bench;
  EXPECT_FALSE(bench.machine.state(bench.line.now()).running);
  EXPECT_THAT(bench.sentence(), HasSubstr("Nothing arrives"));
  bench.line.run(1);
  EXPECT_TRUE(bench.machine.state(bench.line.now()).running);
  bench.emulator.mute(bench.line.now() + 5);
  bench.line.run(2);
  EXPECT_FALSE(bench.machine.state(bench.line.now()).running);
  EXPECT_THAT(bench.sentence(), HasSubstr("silent for 2.0 s"));
  bench.line.run(5);
  EXPECT_TRUE(bench.well());
}

TEST(PsdMachine, AWrongRateIsSaid) {
  PsdSetup setup;
  setup.baud = 57600;
  Bench bench({.baud = 115'200}, setup);
  bench.line.run(3);
  EXPECT_FALSE(bench.machine.state(bench.line.now()).running);
  EXPECT_THAT(bench.sentence(), HasSubstr("no whole line: look at `rate`"));
}

TEST(PsdMachine, ADamagedLineIsSaidOnceItIsBad) {
  Bench bench;
  bench.line.run(1);
  bench.emulator.set_faults({.damage = 0.02});
  EXPECT_EQ(bench.faulty_after(20), kNothing);
  bench.emulator.set_faults({.damage = 0.8});
  EXPECT_LT(bench.faulty_after(3), 3);
  EXPECT_THAT(bench.sentence(), HasSubstr("% of its lines are damaged"));
  bench.emulator.set_faults({});
  bench.line.run(2);
  EXPECT_TRUE(bench.well()) << bench.sentence();
}

TEST(PsdMachine, ASlowAdapterIsSaid) {
  Bench bench;
  bench.line.run(1);
  bench.emulator.slow(1.5);
  EXPECT_EQ(bench.faulty_after(20), kNothing) << bench.sentence();
  for (const double times : {2.5, 3.0, 20.0}) {
    bench.emulator.slow(times);
    EXPECT_LT(bench.faulty_after(8), 5) << times;
    EXPECT_THAT(bench.sentence(), HasSubstr("readings a second arrive instead of 26")) << times;
    bench.emulator.slow(1);
    bench.line.run(1);
    EXPECT_TRUE(bench.well()) << bench.sentence();
  }
}

TEST(PsdMachine, AStuckSensorIsNamed) {
  for (std::size_t sensor = 0; sensor < kSensors; ++sensor) {
    Bench bench;
    bench.line.run(2);
    bench.emulator.stick(sensor, true);
    EXPECT_NEAR(bench.faulty_after(3), StuckWatch::kReadings * kPeriod, 2 * kPeriod);
    EXPECT_FALSE(bench.well());
    EXPECT_THAT(bench.sentence(),
                HasSubstr(std::string("The ") + kSensorNames[sensor] + " sensor is stuck"));
    bench.emulator.stick(sensor, false);
    bench.line.run(0.2);
    EXPECT_TRUE(bench.well()) << bench.sentence();
  }
}

TEST(PsdMachine, AFrozenConverterIsSaid) {
  Bench bench;
  bench.line.run(2);
  for (std::size_t i = 0; i < kSensors; ++i) bench.emulator.stick(i, true);
  EXPECT_LT(bench.faulty_after(3), 3);
  EXPECT_THAT(bench.sentence(), HasSubstr("its converter stands still"));
}

TEST(PsdMachine, AJumpOfTheClockIsSaidForASecond) {
  Bench bench;
  bench.line.run(2);
  bench.emulator.jump(3);
  EXPECT_LE(bench.faulty_after(1), 2 * kPeriod);
  EXPECT_THAT(bench.sentence(), HasSubstr("clock jumped by 3.0 s"));
  bench.line.run(0.9);
  EXPECT_TRUE(bench.faulty());
  bench.line.run(0.3);
  EXPECT_TRUE(bench.well()) << bench.sentence();
}

TEST(PsdMachine, ARestartOfTheAdapterIsSaid) {
  Bench bench;
  bench.line.run(5);
  bench.emulator.restart(bench.line.now(), 0.2);
  EXPECT_LE(bench.faulty_after(1), 0.2 + 2 * kPeriod);
  EXPECT_THAT(bench.sentence(), HasSubstr("it restarted"));
}

TEST(PsdMachine, APluggedOutAdapterComesBack) {
  Bench bench;
  bench.line.run(1);
  bench.line.unplug();
  EXPECT_FALSE(bench.machine.state(bench.line.now()).running);
  algo::FloorRanges ranges;
  EXPECT_FALSE(bench.machine.take(ranges));
  EXPECT_THAT(bench.sentence(), HasSubstr("has gone"));
  bench.line.open();
  bench.line.run(1);
  EXPECT_TRUE(bench.well()) << bench.sentence();
}

/// Bytes held by a poor adapter come late and together.
TEST(PsdMachine, BunchedBytesAreNoJump) {
  Bench bench;
  bench.line.bunch = 0.2;
  EXPECT_EQ(bench.faulty_after(20), kNothing) << bench.sentence();
}

}  // namespace
}  // namespace drivers::psd
