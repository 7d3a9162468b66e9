// tests/algo/teleop/reflected_force_test.cpp: bands, both readings of the forward force, the ramp.
#include "algo/teleop/reflected_force.hpp"

#include <cmath>
#include <random>
#include <vector>

#include "tests/algo/allocations.hpp"
#include "tests/algo/not_finite.hpp"
#include <gtest/gtest.h>

#include "algo/teleop/sonar_ring.hpp"
#include "algo/teleop/speed_limit.hpp"

namespace {

using algo::ForceBand;
using algo::ForceLevels;
using algo::ForwardForce;
using algo::Parameters;

using tests::kInf;
using tests::kNan;
constexpr double kFastest = 0.4;  // [m/s]
constexpr double kBangBang = 0;   // ramp

TEST(ReflectedForce, LimitsAreInsideTheBand) {
  const ForceBand band{.offset = 1000, .half_width = 100};
  for (const double ramp : {kBangBang, 0.2}) {
    EXPECT_EQ(algo::reflected_force(1100, band, {}, ramp), 0);
    EXPECT_EQ(algo::reflected_force(900, band, {}, ramp), 0);
    EXPECT_LT(algo::reflected_force(1101, band, {}, ramp), 0);
    EXPECT_GT(algo::reflected_force(899, band, {}, ramp), 0);
  }
}

/// A ramp of 0.2 is 2000 units: 500 beyond the band is a quarter of the full force.
TEST(ReflectedForce, RisesAlongTheRamp) {
  const ForceBand band{.offset = 1000, .half_width = 100};
  EXPECT_DOUBLE_EQ(algo::reflected_force(1600, band, {}, 0.2), -2500);
  EXPECT_DOUBLE_EQ(algo::reflected_force(400, band, {}, 0.2), 2500);
  EXPECT_EQ(algo::reflected_force(3100, band, {}, 0.2), -10000);
  EXPECT_EQ(algo::reflected_force(9000, band, {}, 0.2), -10000);
}

TEST(ReflectedForce, AheadOnlyPushesBack) {
  const ForceBand band = algo::forward_band(0.2, kFastest);
  EXPECT_EQ(band.offset, 5000);
  EXPECT_EQ(band.half_width, 100);
  EXPECT_EQ(algo::reflected_force(6000, band, algo::kForwardLevels, kBangBang), -10000);
  EXPECT_EQ(algo::reflected_force(0, band, algo::kForwardLevels, kBangBang), 0);
  EXPECT_EQ(algo::reflected_force(-10000, band, algo::kForwardLevels, kBangBang), 0);
}

TEST(ReflectedForce, BesideAWallItTracksTheTurnRateAndElseIsSilent) {
  const ForceBand band = algo::wall_band(-0.1, 0.4);
  EXPECT_EQ(band.offset, -2500);
  EXPECT_LT(algo::reflected_force(0, band, {}, kBangBang), 0);
  EXPECT_GT(algo::reflected_force(-5000, band, {}, kBangBang), 0);
  EXPECT_EQ(algo::wall_band(9, 0.4).offset, 10000) << "the printed law may exceed w_max";
  for (double q = -10000; q <= 10000; q += 500) {
    EXPECT_EQ(algo::reflected_force(q, ForceBand{}, {}, kBangBang), 0) << q;
  }
}

/// v_sprs 0.2 of 0.4 m/s; 1 m away Eq. 4 leaves 0.776870 of the smaller speed.
TEST(ForwardLimit, HasBothReadingsOfThePaperAndOurs) {
  algo::RingReadings readings{};
  readings.fill(1.0);
  const auto limit = [&](ForwardForce reading, double v_cmd) {
    return algo::forward_limit(v_cmd, 0.2, readings, kFastest, Parameters{}, reading);
  };
  EXPECT_EQ(limit(ForwardForce::Sparseness, 0.1), 0.2);
  EXPECT_NEAR(limit(ForwardForce::Executed, 0.1), 0.0776870, 1e-6);
  EXPECT_NEAR(limit(ForwardForce::FullStick, 0.1), 0.1553740, 1e-6);
  EXPECT_EQ(limit(ForwardForce::FullStick, 0.4), limit(ForwardForce::FullStick, 0.1));
}

/// A hand that gives way comes to rest at the limit, except with the force "whenever v_cmd > v":
/// there the limit retreats with the hand, down to the width of the band.
TEST(ForwardLimit, OnlyTheSecondReadingPushesTheHandToRest) {
  algo::RingReadings readings{};
  readings.fill(0.8);
  const auto rest = [&](ForwardForce reading) {
    double q = 10000;
    for (int n = 0; n < 2000; ++n) {
      const double v = q / 10000 * kFastest;
      const double limit =
          algo::forward_limit(v, kFastest, readings, kFastest, Parameters{}, reading);
      const ForceBand band = algo::forward_band(limit, kFastest);
      q += 1e-3 * algo::reflected_force(q, band, algo::kForwardLevels, kBangBang);
    }
    return q;
  };
  EXPECT_EQ(rest(ForwardForce::Sparseness), 10000);
  // 10000 (1 - exp(-3 x 0.3)) = 5934, and the band's 100.
  EXPECT_NEAR(rest(ForwardForce::FullStick), 6034, 10);
  EXPECT_LT(rest(ForwardForce::Executed), 300);
}

TEST(ForceBands, StayInTheirRangesForAnyBounds) {
  const std::vector<double> values{kNan, kInf, -kInf, 0, -0.0, 1, -1, 0.3, 1e300, -1e300};
  for (const double a : values) {
    for (const double b : values) {
      for (const double most : values) {
        for (const ForceBand& band : {algo::band_between(a, b, most),
                                      algo::forward_band(a, most),
                                      algo::wall_band(b, most)}) {
          EXPECT_LE(std::abs(band.offset), 10000);
          EXPECT_TRUE(band.half_width >= 0 && band.half_width <= 10000);
        }
      }
    }
  }
}

TEST(ReflectedForce, NeverPushesOutwardsOrBeyondItsLevels) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> stick(-10000, 10000), unit(0, 1);
  for (int n = 0; n < 20'000; ++n) {
    const ForceBand band{.offset = stick(random), .half_width = 10000 * unit(random)};
    const ForceLevels levels{.above = 10000 * unit(random), .below = 10000 * unit(random)};
    const double q = n % 50 == 0 ? kNan : stick(random);
    const double force = algo::reflected_force(q, band, levels, n % 3 == 0 ? 0 : unit(random));
    ASSERT_TRUE(std::isfinite(force));
    EXPECT_TRUE(force >= -levels.above && force <= levels.below);
    if (force < 0) {
      EXPECT_GT(q, band.offset);
    }
    if (force > 0) {
      EXPECT_LT(q, band.offset);
    }
  }
}

TEST(ReflectedForce, AllocatesNothing) {
  algo::RingReadings readings{};
  const Parameters parameters;
  const auto before = allocations::count();
  const double limit = algo::forward_limit(kFastest, kFastest, readings, kFastest, parameters);
  EXPECT_NE(algo::reflected_force(
                9000, algo::forward_band(limit, kFastest), algo::kForwardLevels, kBangBang),
            0);
  EXPECT_EQ(allocations::count(), before);
}

}  // namespace
