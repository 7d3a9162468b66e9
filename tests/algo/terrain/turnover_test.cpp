// tests/algo/terrain/turnover_test.cpp: Eq. 20-26 and the rule along the track, by hand.
#include "algo/terrain/turnover.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "algo/units.hpp"

namespace {

using algo::Attitude;
using algo::Stance;
using namespace algo::units;

constexpr double kTopSpeed = 0.86;
constexpr double kTopTurn = std::numbers::pi / 2;
constexpr Stance kLow{.mass_height = 0.25, .width = 0.48, .length = 0.60};
constexpr Stance kHigh{.mass_height = 0.90, .width = 0.48, .length = 0.60};

double fastest_left(double roll, const Stance& stance, double v = kTopSpeed) {
  return algo::turn_range(algo::sideways_range({.roll = roll}, stance), v, kTopSpeed, kTopTurn).max;
}

/// equations.md G: the bound of h 0.90 begins to bind at 7.28 degrees, that of h 0.25 at 38.1.
TEST(Turnover, BindsFromTheAngleOfThePaper) {
  EXPECT_EQ(fastest_left(7.27_deg, kHigh), kTopTurn);
  EXPECT_LT(fastest_left(7.29_deg, kHigh), kTopTurn);
  EXPECT_EQ(fastest_left(38.0_deg, kLow), kTopTurn);
  EXPECT_LT(fastest_left(38.2_deg, kLow), kTopTurn);
}

/// On 10 degrees, left side up: a left turn pushes the robot down the slope.
TEST(Turnover, BindsOnTheSideThatFallsDownhill) {
  const auto turn = algo::turn_range(
      algo::sideways_range({.roll = 10_deg}, kHigh), kTopSpeed, kTopSpeed, kTopTurn);
  EXPECT_NEAR(turn.max, 0.8725 / 0.86, 1e-3);
  const auto back = algo::turn_range(
      algo::sideways_range({.roll = 10_deg}, kHigh), -kTopSpeed, kTopSpeed, kTopTurn);
  EXPECT_NEAR(back.min, -turn.max, 1e-12);  // backwards, a right turn does
  EXPECT_FALSE(turn.must_turn);
}

TEST(Turnover, MustTurnPastTheStandingLimit) {
  const double limit = std::atan(0.48 / 1.8);  // 14.93 degrees
  EXPECT_NEAR(algo::standing_margin({.roll = 10_deg}, kHigh), limit - 10_deg, 1e-12);
  for (const double sign : {1.0, -1.0}) {
    const auto beyond = algo::sideways_range({.roll = sign * 15_deg}, kHigh);
    EXPECT_TRUE(algo::turn_range(beyond, kTopSpeed, kTopSpeed, kTopTurn).must_turn);
    EXPECT_TRUE(algo::turn_range(beyond, 0, kTopSpeed, kTopTurn).must_turn);
    EXPECT_LT(algo::standing_margin({.roll = sign * 15_deg}, kHigh), 0);
  }
}

/// 9.80665 x 0.6 / 1.8 = 3.27 m/s2 on the flat; on 10 degrees 9.80665 (0.9848 / 3 - 0.1736) = 1.52.
TEST(Turnover, BrakesLessOnASlope) {
  EXPECT_NEAR(algo::along_limit({}, kHigh, 1), 3.2689, 1e-3);
  EXPECT_NEAR(algo::along_limit({.pitch = 10_deg}, kHigh, 1), 1.5163, 1e-3);
  EXPECT_EQ(algo::along_limit({.pitch = 10_deg}, kHigh, 0.5),
            algo::along_limit({.pitch = -10_deg}, kHigh, 0.5));
  EXPECT_LT(algo::along_limit({.pitch = 19_deg}, kHigh, 0.9), 0);
}

}  // namespace
