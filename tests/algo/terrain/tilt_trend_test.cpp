// tests/algo/terrain/tilt_trend_test.cpp: the trend of an inclinometer's readings.
#include "algo/terrain/tilt_trend.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace {

constexpr double kTrendTick = 0.025;  // [s]

TEST(TiltTrend, GoesOnAlongALine) {
  algo::TiltTrend trend;
  EXPECT_EQ(trend.after(1), algo::Attitude{});
  for (int k = 0; k < 40; ++k) {
    const double t = k * kTrendTick;
    trend.take(t, {.roll = 0.02 + 0.3 * t, .pitch = 0.1 - 0.2 * t});
  }
  const double then = 39 * kTrendTick + 0.35;
  EXPECT_NEAR(trend.after(0.35).roll, 0.02 + 0.3 * then, 1e-12);
  EXPECT_NEAR(trend.after(0.35).pitch, 0.1 - 0.2 * then, 1e-12);
}

TEST(TiltTrend, IsTheNewestReadingWhileThereAreFew) {
  algo::TiltTrend trend;
  trend.take(0, {.roll = 0.1});
  trend.take(kTrendTick, {.roll = 0.2});
  EXPECT_EQ(trend.after(1).roll, 0.2);
  // Old readings do not count: after a gap the trend begins anew.
  for (int k = 0; k < 10; ++k) trend.take(1 + k * kTrendTick, {.roll = 0.1 * k});
  trend.take(5, {.roll = 0.3});
  EXPECT_EQ(trend.after(1).roll, 0.3);
  trend.reset();
  EXPECT_EQ(trend.after(1), algo::Attitude{});
}

/// Readings that alternate by 0.2 degrees have hardly a trend; their last difference has.
TEST(TiltTrend, SmoothsNoise) {
  algo::TiltTrend trend;
  constexpr double kNoise = 0.0035;
  for (int k = 0; k < 40; ++k) trend.take(k * kTrendTick, {.roll = k % 2 == 0 ? kNoise : -kNoise});
  EXPECT_LT(std::abs(trend.after(0.35).roll), 3 * kNoise);
}

}  // namespace
