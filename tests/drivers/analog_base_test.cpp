// tests/drivers/analog_base_test.cpp: volts and counts of a card that is not there.
#include "drivers/analog_base.hpp"

#include <numbers>

#include <gtest/gtest.h>

namespace drivers {
namespace {

double g_now = 0;  // NOLINT: the base takes a plain function for its clock

/// Amplifiers and wheels that do exactly as told.
class FakeCard final : public AnalogCard {
 public:
  std::array<double, 2> volts{};
  std::array<std::uint32_t, 2> counts{4294967290U, 4294967290U};  // shortly before the wrap
  bool on = true;

  void write_volts(const std::array<double, 2>& wanted) override { volts = wanted; }
  std::array<std::uint32_t, 2> read_counts() override { return counts; }
  void enable(bool wanted) override { on = wanted; }
  bool enabled() const override { return on; }
  double watchdog() const override { return 0.2; }
};

AnalogSetup setup() {
  AnalogSetup out;
  out.wheel_radius = 0.1;
  out.half_track = 0.25;
  out.counts_per_turn = 2000;
  out.metres_per_second_volt = 0.1;
  out.limits = {.speed = 0.5, .turn = 1};
  return out;
}

struct Fixture {
  FakeCard card{};
  AnalogBase base{card, setup(), [] { return g_now; }};
};

TEST(AnalogBase, StartsAtRestAndOff) {
  const Fixture f;
  EXPECT_FALSE(f.card.on);
  EXPECT_EQ(f.card.volts, (std::array<double, 2>{0, 0}));
}

TEST(AnalogBase, SpeedsBecomeVolts) {
  Fixture f;
  f.base.enable(true);
  f.base.drive({0.2, 0.4});  // left 0.1, right 0.3 m/s
  EXPECT_NEAR(f.card.volts[0], 1, 1e-12);
  EXPECT_NEAR(f.card.volts[1], 3, 1e-12);
  f.base.drive({9, 0});
  EXPECT_NEAR(f.card.volts[0], 5, 1e-12);  // the limit, 0.5 m/s
  f.base.stop();
  EXPECT_EQ(f.card.volts, (std::array<double, 2>{0, 0}));
}

TEST(AnalogBase, CountsAddUpOverTheWrap) {
  Fixture f;
  g_now += 1;
  for (std::uint32_t& count : f.card.counts) count += 2000;  // one turn each
  f.base.drive({});
  EXPECT_NEAR(f.base.state().pose.x, 0.2 * std::numbers::pi, 1e-9);
  EXPECT_NEAR(f.base.state().twist.v, 0.2 * std::numbers::pi, 1e-9);
}

TEST(AnalogBase, AtRestNothingCreeps) {
  AnalogSetup with = setup();
  with.gain = 5;
  FakeCard card;
  AnalogBase base(card, with, [] { return g_now; });
  g_now += 0.05;
  card.counts[0] += 3;
  base.drive({});
  EXPECT_EQ(card.volts, (std::array<double, 2>{0, 0}));
}

}  // namespace
}  // namespace drivers
