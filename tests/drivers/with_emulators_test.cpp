// tests/drivers/with_emulators_test.cpp: the drivers' machines against the strict emulators, which
// were written from the manuals independently. The line takes its transfer time on a simulated
// clock.
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/drivers/emulated_laser.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/emulators/p2os_emulator.hpp"
#include "drivers/emulators/roboteq_emulator.hpp"
#include "drivers/p2os_machine.hpp"
#include "drivers/roboteq_machine.hpp"

namespace drivers {
namespace {

TEST(WithEmulators, ScansArriveToTheMillimetreInEveryVariant) {
  for (const lms200::Variant variant :
       {lms200::Variant{180, 100}, {180, 50}, {100, 100}, {100, 50}, {100, 25}}) {
    Laser laser({}, setup(500'000, variant));
    ASSERT_TRUE(laser.running(15)) << laser.machine.report().trouble;
    laser.expect_room(variant.beams());
    EXPECT_THAT(laser.machine.report().remarks, ::testing::IsEmpty());
  }
}

TEST(WithEmulators, EveryRateWorks) {
  for (const unsigned baud : {9600U, 19200U, 38400U, 500'000U}) {
    Laser laser({}, setup(baud));
    ASSERT_TRUE(laser.running(20)) << baud << laser.machine.report().trouble;
    laser.expect_room(361);
    EXPECT_EQ(laser.emulator.baud(), baud);
  }
}

TEST(WithEmulators, QuartersOfADegreeComeInterlaced) {
  lms200::EmulatorOptions options;
  options.interlaced = true;
  Laser laser(options, setup(500'000, {180, 25}));
  ASSERT_TRUE(laser.running(15)) << laser.machine.report().trouble;
  laser.expect_room(721);
}

TEST(WithEmulators, SetUpHandlesAddressOneSlowBootAndStoredRate) {
  lms200::EmulatorOptions options;
  options.address = 1;
  options.powered = false;
  options.boot_time = 9;
  Laser laser(options);
  ASSERT_TRUE(laser.running(40)) << laser.machine.report().trouble;
  EXPECT_EQ(laser.machine.report().address, 1);
  laser.expect_room(361);

  lms200::EmulatorOptions stored;
  stored.start_rate = 500'000;
  stored.start_up = lms200::StartUpRate::KeepPresent;
  Laser fast(stored);
  EXPECT_TRUE(fast.running(5));
}

TEST(WithEmulators, ConfigurationIsWrittenOnlyOnce) {
  Laser laser({});
  ASSERT_TRUE(laser.running(15));
  const unsigned writes = laser.emulator.memory_writes();
  EXPECT_LE(writes, 2U);
  laser.emulator.restart(laser.bench.now(), 3);
  ASSERT_TRUE(laser.bench.run_until(30, [&] { return laser.machine.report().set_ups == 2; }));
  EXPECT_EQ(laser.machine.report().written, laser.machine.report().written > 0 ? 1U : 0U);
}

TEST(WithEmulators, OnlyDamagedTelegramsAreLost) {
  Laser laser({});
  ASSERT_TRUE(laser.running(15));
  laser.bench.run(0.5);
  const std::uint64_t before = laser.machine.report().scans;
  const std::uint64_t intact = laser.intact;
  laser.emulator.set_faults({.damage = 0.05});
  laser.bench.run(20);
  laser.emulator.set_faults({});
  laser.bench.run(0.5);
  EXPECT_GT(laser.damaged, 10U);
  const std::uint64_t came = laser.machine.report().scans - before;
  const std::uint64_t sent = laser.intact - intact;
  EXPECT_LE(sent - came, 2U) << "of " << sent << " intact ones, beside " << laser.damaged;
  EXPECT_EQ(laser.machine.report().set_ups, 1U);
}

TEST(WithEmulators, SetUpSucceedsOnANoisyLine) {
  lms200::EmulatorOptions options;
  options.seed = 7;
  Laser laser(options);
  laser.emulator.set_faults({.damage = 0.1});
  EXPECT_TRUE(laser.running(60)) << laser.machine.report().trouble;
}

TEST(WithEmulators, LaserIsLeftAtItsFirstRate) {
  Laser laser({});
  ASSERT_TRUE(laser.running(15));
  laser.machine.leave(laser.bench.now());
  laser.bench.settle();
  ASSERT_TRUE(laser.bench.run_until(3, [&] { return laser.machine.left(); }));
  laser.bench.run(0.2);
  EXPECT_EQ(laser.emulator.baud(), 9600U);
  EXPECT_EQ(laser.emulator.mode(), lms200::Mode::OnRequest);
}

// ---- bases -----------------------------------------------------------------------------------

/// Wheels that follow the motors exactly.
class EmulatedBase final : public Emulated {
 public:
  template <class Emulator>
  explicit EmulatedBase(Emulator& base) : Emulated(base), base_(base) {}

  emulators::BaseSenses senses{};
  emulators::WheelMotion motion{};

 protected:
  void live(double now) override {
    const double dt = last_ > 0 ? now - last_ : 0;
    last_ = now;
    motion = base_.turn(now);
    senses.left_travel += motion.left * dt;
    senses.right_travel += motion.right * dt;
    senses.motion = motion;
    base_.sense(senses, now);
  }

 private:
  emulators::Base& base_;
  double last_ = 0;
};

BaseLimits limits() {
  return {.speed = 0.3, .turn = 1.0, .acceleration = 1, .turn_acceleration = 2};
}
p2os::PioneerSetup pioneer() {
  p2os::PioneerSetup out;
  out.limits = limits();
  return out;
}
roboteq::RoboteqSetup roboteq_setup() {
  roboteq::RoboteqSetup out;
  out.wheel = {.radius = 0.1, .gear = 20, .encoder_lines = 500, .full_speed_rpm = 1000};
  out.half_track = 0.165;
  out.limits = limits();
  return out;
}

template <class Emulator, class Machine>
struct Rig {
  template <class Setup>
  Rig(const typename std::type_identity<Setup>::type& setup, std::type_identity<Setup> /*tag*/)
      : device(emulator), machine(setup), bench(machine, device) {
    bench.open();
  }
  Rig(const Rig&) = delete;
  Rig& operator=(const Rig&) = delete;

  bool ready(double seconds = 20) {
    return bench.run_until(seconds, [&] { return machine.state().running; });
  }
  bool arm() {
    machine.enable(bench.now(), true);
    return bench.run_until(2, [&] { return machine.state().motors_on; });
  }
  void drive(const algo::Twist2& twist, double seconds) {
    for (const double until = bench.now() + seconds; bench.now() < until;) {
      machine.drive(bench.now(), twist);
      bench.settle();
      bench.run(0.05);
    }
  }
  double travel() const { return (device.senses.left_travel + device.senses.right_travel) / 2; }

  Emulator emulator{};
  EmulatedBase device;
  Machine machine;
  LineBench bench;
};

/// The requirements on every base.
template <class Rig>
void check_base(Rig& rig) {
  ASSERT_TRUE(rig.ready()) << rig.machine.report(rig.bench.now()).sentence;
  // Not enabled: nothing moves.
  rig.drive({0.2, 0}, 1);
  EXPECT_NEAR(rig.travel(), 0, 1e-9);

  ASSERT_TRUE(rig.arm());
  rig.drive({0.2, 0}, 3);
  EXPECT_NEAR(rig.device.motion.left, 0.2, 0.01);
  EXPECT_NEAR(rig.machine.state().pose.x, rig.travel(), 0.03);
  EXPECT_NEAR(rig.machine.state().twist.v, 0.2, 0.01);

  // GIVEN no further command WHEN the watchdog's time is over THEN the base stands.
  rig.bench.run(rig.machine.watchdog() + 1);
  EXPECT_NEAR(rig.device.motion.left, 0, 1e-9);

  // The slow speeds of the thesis.
  rig.drive({0.04, 0}, 2);
  EXPECT_NEAR(rig.device.motion.left, 0.04, 0.004);

  // Turning left.
  const double heading = rig.machine.state().pose.heading;
  rig.drive({0, 0.5}, 2);
  rig.drive({}, 1);
  const double turned = (rig.device.senses.right_travel - rig.device.senses.left_travel) / 0.33;
  EXPECT_GT(turned, 0.5);
  EXPECT_NEAR(algo::wrap_angle(rig.machine.state().pose.heading - heading), turned, 0.05);

  // The stop button.
  rig.drive({0.2, 0}, 1);
  rig.emulator.press_stop_button(true);
  rig.bench.run(0.3);
  EXPECT_TRUE(rig.machine.state().stop_button);
  EXPECT_FALSE(rig.machine.state().motors_on);
  EXPECT_NEAR(rig.device.motion.left, 0, 1e-9);
  rig.emulator.press_stop_button(false);
  rig.machine.enable(rig.bench.now(), false);
  rig.bench.settle();
  rig.bench.run(0.3);
  EXPECT_FALSE(rig.machine.state().stop_button);
  ASSERT_TRUE(rig.arm());

  // After a restart the base is found and set up again, with its motors off.
  rig.emulator.restart(rig.bench.now(), 2);
  ASSERT_TRUE(rig.bench.run_until(30, [&] { return rig.machine.state().set_ups == 2; }));
  EXPECT_FALSE(rig.machine.state().motors_on);
}

/// Brakes from 0.3 m/s on a driving ramp of 0.3 m/s2, which would take 0.15 m.
template <class Rig>
void check_braking(Rig& rig) {
  ASSERT_TRUE(rig.ready());
  ASSERT_TRUE(rig.arm());
  rig.drive({0.3, 0}, 4);
  ASSERT_NEAR(rig.device.motion.left, 0.3, 0.01);
  const double before = rig.travel();
  for (int tick = 0; tick < 20; ++tick) {
    rig.machine.halt(rig.bench.now());
    rig.bench.settle();
    rig.bench.run(0.05);
  }
  EXPECT_EQ(rig.device.motion.left, 0);
  EXPECT_LE(rig.travel() - before, 0.3 * 0.3 / (2 * kEmergencyDeceleration) + 0.3 * 0.05);
  // The motors stay on, and the driving ramp of the file is restored.
  rig.drive({0.3, 0}, 4);
  EXPECT_NEAR(rig.device.motion.left, 0.3, 0.01);
  rig.drive({}, 0.5);
  EXPECT_GT(rig.device.motion.left, 0.1);
  // Switched off while driving: it brakes first, then loses power.
  rig.drive({0.3, 0}, 4);
  rig.machine.enable(rig.bench.now(), false);
  rig.bench.run(0.05);
  EXPECT_TRUE(rig.emulator.powered());
  rig.bench.run(1);
  EXPECT_FALSE(rig.emulator.powered());
  EXPECT_EQ(rig.device.motion.left, 0);
}

BaseLimits gentle() {
  return {.speed = 0.3, .turn = 1.0, .acceleration = 0.3, .turn_acceleration = 1.0};
}

TEST(WithEmulators, PioneerBrakesWithItsEmergencyRamp) {
  p2os::PioneerSetup setup = pioneer();
  setup.limits = gentle();
  Rig<p2os::Emulator, p2os::PioneerMachine> rig(setup, std::type_identity<p2os::PioneerSetup>());
  check_braking(rig);
}

TEST(WithEmulators, RoboteqBrakesWithItsEmergencyRamp) {
  roboteq::RoboteqSetup setup = roboteq_setup();
  setup.limits = gentle();
  setup.limits.turn_acceleration = 0.01;  // its ramps are of the wheels, and a turn's part adds up
  Rig<roboteq::Emulator, roboteq::RoboteqMachine> rig(setup,
                                                      std::type_identity<roboteq::RoboteqSetup>());
  check_braking(rig);
}

TEST(WithEmulators, PioneerReportsItsWatchdog) {
  Rig<p2os::Emulator, p2os::PioneerMachine> rig(pioneer(),
                                                std::type_identity<p2os::PioneerSetup>());
  ASSERT_TRUE(rig.ready());
  rig.bench.run(1);
  ASSERT_TRUE(rig.machine.state().watchdog);
  EXPECT_DOUBLE_EQ(*rig.machine.state().watchdog, 2.0);
}

TEST(WithEmulators, RoboteqReportsABlockedWheelAtAnyCurrent) {
  Rig<roboteq::Emulator, roboteq::RoboteqMachine> rig(roboteq_setup(),
                                                      std::type_identity<roboteq::RoboteqSetup>());
  ASSERT_TRUE(rig.ready());
  EXPECT_THAT(rig.machine.report(rig.bench.now()).remarks,
              ::testing::Contains(::testing::HasSubstr("^CLERD was set")));
  ASSERT_TRUE(rig.arm());
  rig.drive({0.2, 0}, 2);
  EXPECT_FALSE(rig.machine.state().stalled);
  rig.emulator.trouble.blocked = true;
  rig.drive({0.2, 0}, 0.5);
  EXPECT_TRUE(rig.machine.state().stalled);
  EXPECT_THAT(rig.machine.report(rig.bench.now()).sentence, ::testing::HasSubstr("blocked"));
}

TEST(WithEmulators, PioneerIsDrivenAndStops) {
  Rig<p2os::Emulator, p2os::PioneerMachine> rig(pioneer(),
                                                std::type_identity<p2os::PioneerSetup>());
  check_base(rig);
}

TEST(WithEmulators, RoboteqIsDrivenAndStops) {
  Rig<roboteq::Emulator, roboteq::RoboteqMachine> rig(roboteq_setup(),
                                                      std::type_identity<roboteq::RoboteqSetup>());
  check_base(rig);
}

}  // namespace
}  // namespace drivers
