// tests/drivers/analog_base_test.cpp: voltages and counts of a fake card.
#include "drivers/analog_base.hpp"

#include <chrono>
#include <cmath>
#include <numbers>
#include <thread>

#include "tests/drivers/fake_card.hpp"
#include <gtest/gtest.h>

namespace drivers {
namespace {

using algo::Twist2;

double g_now = 0;  // NOLINT: the base takes a plain function for its clock

constexpr double kAnalogTick = 0.05;  // [s]
constexpr Volts kNone{0, 0};

AnalogSetup analog_setup() {
  AnalogSetup out;
  out.wheel_radius = 0.1;
  out.half_track = 0.25;
  out.counts_per_turn = 2000;
  out.speed_per_volt = 0.1;
  out.limits = {.speed = 0.5, .turn = 1, .acceleration = 1, .turn_acceleration = 4};
  return out;
}

struct Bench {
  explicit Bench(const AnalogSetup& with = analog_setup())
      : base(
            "card",
            with,
            [this] { return std::make_unique<FakeCard>(wiring); },
            [] { return g_now; }) {}

  /// Waits for the thread that opens the card.
  bool comes_to(bool running) {
    for (int i = 0; i < 500 && base.state().running != running; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return base.state().running == running;
  }
  void drive(const Twist2& twist, int ticks) {
    for (int i = 0; i < ticks; ++i) {
      g_now += kAnalogTick;
      base.drive(twist);
    }
  }
  void roll(std::uint32_t counts) {
    for (std::uint32_t& count : wiring.inputs.counts) count += counts;
  }

  // Counts shortly before the wrap. Before the base, whose thread reads them.
  Wiring wiring{.inputs = {.counts = {4294967290U, 4294967290U}}};
  AnalogBase base;
};

TEST(AnalogBase, StartsAtRestAndOff) {
  Bench bench;
  ASSERT_TRUE(bench.comes_to(true));
  EXPECT_EQ(bench.wiring.volts, kNone);
  EXPECT_FALSE(bench.base.state().motors_on);
  EXPECT_EQ(bench.wiring.relay_changes, 0U);
  bench.drive({0.2, 0}, 3);
  EXPECT_EQ(bench.wiring.volts, kNone) << "before anybody has switched it on";
  EXPECT_EQ(bench.wiring.relay_changes, 0U);
}

TEST(AnalogBase, SpeedsBecomeVoltsAlongTheRamp) {
  Bench bench;
  ASSERT_TRUE(bench.comes_to(true));
  bench.base.enable(true);
  bench.drive({0.2, 0}, 1);
  EXPECT_NEAR(bench.wiring.volts[0], 0.5, 1e-9);  // 1 m/s2 for a tick
  bench.drive({0.2, 0.4}, 10);                    // left 0.1, right 0.3 m/s
  EXPECT_NEAR(bench.wiring.volts[0], 1, 1e-9);
  EXPECT_NEAR(bench.wiring.volts[1], 3, 1e-9);
  bench.drive({9, 0}, 20);
  EXPECT_NEAR(bench.wiring.volts[0], 5, 1e-9);  // the limit, 0.5 m/s
  bench.base.stop();
  EXPECT_EQ(bench.wiring.volts, kNone) << "a stop knows no ramp";
}

TEST(AnalogBase, NanCommandsMoveNothing) {
  Bench bench;
  ASSERT_TRUE(bench.comes_to(true));
  bench.base.enable(true);
  bench.drive({std::nan(""), std::nan("")}, 5);
  EXPECT_EQ(bench.wiring.volts, kNone);
}

TEST(AnalogBase, OnlyTicksToggleTheRelay) {
  Bench bench;
  ASSERT_TRUE(bench.comes_to(true));
  bench.base.enable(true);
  EXPECT_TRUE(bench.wiring.enabled);
  const unsigned before = bench.wiring.relay_changes;
  bench.drive({0.1, 0}, 4);
  EXPECT_EQ(bench.wiring.relay_changes, before + 4);
  for (int i = 0; i < 20; ++i) {
    g_now += kAnalogTick;
    bench.base.state();
    bench.base.report();
  }
  EXPECT_EQ(bench.wiring.relay_changes, before + 4);
  bench.base.cut();
  bench.drive({0.1, 0}, 4);
  EXPECT_EQ(bench.wiring.relay_changes, before + 4) << "a relay that was cut stays open";
  EXPECT_FALSE(bench.wiring.enabled);
  EXPECT_EQ(bench.wiring.volts, kNone);
}

TEST(AnalogBase, SwitchingOffBrakesWithPowerThenOpensTheRelay) {
  Bench bench;
  ASSERT_TRUE(bench.comes_to(true));
  bench.base.enable(true);
  for (int i = 0; i < 20; ++i) {
    bench.roll(32);  // 0.2 m/s
    bench.drive({0.2, 0}, 1);
  }
  EXPECT_NEAR(bench.base.state().twist.v, 0.2, 0.01);
  bench.base.enable(false);
  EXPECT_EQ(bench.wiring.volts, kNone);
  bench.roll(16);
  g_now += kAnalogTick;
  bench.base.stop();
  EXPECT_TRUE(bench.base.state().motors_on)
      << "it rolls: an amplifier without power does not brake";
  for (int i = 0; i < 6; ++i) {
    g_now += kAnalogTick;
    bench.base.state();
    bench.base.stop();
  }
  EXPECT_FALSE(bench.base.state().motors_on);
  EXPECT_FALSE(bench.wiring.enabled);
}

TEST(AnalogBase, OdometryContinuesOverTheCounterWrap) {
  Bench bench;
  ASSERT_TRUE(bench.comes_to(true));
  g_now += 1;
  bench.roll(2000);  // one turn
  EXPECT_NEAR(bench.base.state().pose.x, 0.2 * std::numbers::pi, 1e-9);
  EXPECT_NEAR(bench.base.state().twist.v, 0.2 * std::numbers::pi, 1e-9);
}

TEST(AnalogBase, ACounterResetAddsNoTravel) {
  Bench bench;
  ASSERT_TRUE(bench.comes_to(true));
  g_now += kAnalogTick;
  bench.wiring.inputs.counts = {1'000'000'000, 0};
  EXPECT_EQ(bench.base.state().pose, algo::Pose2{});
  g_now += 1;
  bench.roll(200);
  EXPECT_NEAR(bench.base.state().pose.x, 0.02 * std::numbers::pi, 1e-9);
}

TEST(AnalogBase, NothingCreepsAtRest) {
  AnalogSetup with = analog_setup();
  with.gain = 5;
  Bench bench(with);
  ASSERT_TRUE(bench.comes_to(true));
  bench.base.enable(true);
  bench.wiring.inputs.counts[0] += 30;
  bench.drive({}, 3);
  EXPECT_EQ(bench.wiring.volts, kNone);
}

TEST(AnalogBase, TheProportionalTermSpeedsUpASlowWheel) {
  AnalogSetup with = analog_setup();
  with.gain = 5;  // [V s/m]
  Bench bench(with);
  ASSERT_TRUE(bench.comes_to(true));
  bench.base.enable(true);
  for (int i = 0; i < 20; ++i) {
    bench.roll(16);  // 0.1 m/s
    bench.drive({0.2, 0}, 1);
  }
  EXPECT_NEAR(bench.wiring.volts[0], 2 + 5 * 0.1, 0.05);
}

TEST(AnalogBase, ReportsTheDigitalLines) {
  Bench bench;
  ASSERT_TRUE(bench.comes_to(true));
  bench.wiring.inputs.stop_button = true;
  bench.wiring.inputs.bumper_front = true;
  g_now += kAnalogTick;
  EXPECT_TRUE(bench.base.state().stop_button);
  EXPECT_TRUE(bench.base.state().bumper_front);
  EXPECT_FALSE(bench.base.report().well);
  EXPECT_NE(bench.base.report().sentence.find("stop button"), std::string::npos);
  bench.wiring.inputs = {};
  bench.wiring.inputs.fault = true;
  bench.wiring.inputs.relay_closed = false;
  bench.base.enable(true);
  g_now += kAnalogTick;
  EXPECT_TRUE(bench.base.state().faulty);
  EXPECT_FALSE(bench.base.state().motors_on) << "told to close, the relay is open";
  EXPECT_NE(bench.base.report().sentence.find("fault"), std::string::npos);
}

TEST(AnalogBase, ALostCardIsReopenedWithMotorsOff) {
  Bench bench;
  ASSERT_TRUE(bench.comes_to(true));
  bench.base.enable(true);
  bench.drive({0.1, 0}, 5);
  bench.wiring.gone = true;
  bench.drive({0.1, 0}, 1);
  EXPECT_FALSE(bench.base.state().running);
  EXPECT_EQ(bench.base.report().sentence, "The card has gone.");
  bench.base.stop();  // harmless at rest
  bench.base.cut();
  bench.wiring.gone = false;
  ASSERT_TRUE(bench.comes_to(true));
  EXPECT_EQ(bench.base.state().set_ups, 2U);
  EXPECT_FALSE(bench.base.state().motors_on);
  EXPECT_EQ(bench.wiring.volts, kNone);
}

TEST(AnalogBase, ACardThatOpensAndFailsIsNotOpenedWithoutPause) {
  Wiring wiring;
  wiring.refuses_volts = true;
  AnalogBase base("card", analog_setup(), [&] { return std::make_unique<FakeCard>(wiring); });
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_LE(wiring.opened, 2U);
  EXPECT_FALSE(base.state().running);
  EXPECT_EQ(base.report().sentence, "The card accepts no voltage.");
}

TEST(AnalogBase, LeavesZeroVoltsBehind) {
  Wiring wiring;
  {
    AnalogBase base(
        "card",
        analog_setup(),
        [&] { return std::make_unique<FakeCard>(wiring); },
        [] { return g_now; });
    for (int i = 0; i < 500 && !base.state().running; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    base.enable(true);
    for (int i = 0; i < 5; ++i) {
      g_now += kAnalogTick;
      base.drive({0.3, 0});
    }
    EXPECT_GT(wiring.volts[0], 0);
  }
  EXPECT_EQ(wiring.volts, kNone);
}

}  // namespace
}  // namespace drivers
