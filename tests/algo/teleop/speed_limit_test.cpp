// tests/algo/teleop/speed_limit_test.cpp: how the speed falls and recovers.
#include "algo/teleop/speed_limit.hpp"

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "tests/algo/allocations.hpp"
#include "tests/algo/not_finite.hpp"
#include <gtest/gtest.h>

namespace {

using algo::Parameters;
using algo::RingReadings;

using tests::kInf;
using tests::kNan;
constexpr double kTop = 0.4;  // [m/s] of the paper's course

RingReadings all(double d) {
  RingReadings readings{};
  readings.fill(d);
  return readings;
}

/// Samples until the sparseness, from `start`, stays the same under `readings`.
int samples_to_rest(double start, const RingReadings& readings) {
  double sparseness = start;
  for (int n = 0; n < 1000; ++n) {
    const double next = algo::sparseness_step(sparseness, readings, kTop, Parameters{}).next;
    if (next == sparseness) return n;
    sparseness = next;
  }
  return -1;
}

/// ln(0.1) / ln(0.9) = 21.85: the 22nd sample reaches the least sparseness, after 2.2 s.
TEST(Sparseness, RingsDownIn22Samples) {
  const int samples = samples_to_rest(1.0, all(0.2));
  EXPECT_EQ(samples, 22);
  EXPECT_NEAR(samples * algo::kTeleopPeriod, 2.2, 1e-9);
  EXPECT_EQ(samples_to_rest(0.1, all(3.0)), 22) << "and recovers as fast";
}

/// With an obstacle at a steady distance the range A settles about it: 3 m x 0.9^n around 1.5 m.
TEST(Sparseness, SettlesAboutTheNearestObstacle) {
  double sparseness = 1;
  for (int n = 0; n < 100; ++n) {
    sparseness = algo::sparseness_step(sparseness, all(1.5), kTop, Parameters{}).next;
    if (n < 10) continue;
    EXPECT_GT(sparseness * 3, 1.5 * 0.9);
    EXPECT_LT(sparseness * 3, 1.5 / 0.9);
  }
}

TEST(Sparseness, OneNearReadingIsEnough) {
  RingReadings readings = all(3.0);
  readings[7] = 2.9;
  EXPECT_DOUBLE_EQ(algo::sparseness_step(1, readings, kTop, Parameters{}).next, 0.9);
}

TEST(Sparseness, NoEchoIsFarAndNanIsNear) {
  EXPECT_EQ(algo::sparseness_step(1, all(kInf), kTop, Parameters{}).next, 1);
  RingReadings readings = all(3.0);
  readings[3] = kNan;
  EXPECT_DOUBLE_EQ(algo::sparseness_step(1, readings, kTop, Parameters{}).next, 0.9);
  EXPECT_DOUBLE_EQ(algo::sparseness_step(1, {}, kTop, Parameters{}).next, 0.9);
}

TEST(SlowedSpeed, StopsAtTheStopDistanceAndForNan) {
  RingReadings readings = all(3.0);
  for (const double near : {0.5, 0.1, 0.0, -1.0, -kInf, kNan}) {
    readings[2] = near;
    EXPECT_EQ(algo::slowed_speed(kTop, kTop, readings, kTop, Parameters{}), 0) << near;
  }
  EXPECT_EQ(algo::slowed_speed(kTop, kTop, {}, kTop, Parameters{}), 0);
}

/// 1 m away: 0.4 (1 - exp(-3 x 0.5)) = 0.4 x 0.776870 = 0.310748.
TEST(SlowedSpeed, FallsTowardsTheObstacle) {
  EXPECT_NEAR(algo::slowed_speed(kTop, kTop, all(1.0), kTop, Parameters{}), 0.310748, 1e-6);
  double before = 0;
  for (double d = 0.5; d <= 3; d += 0.01) {
    const double v = algo::slowed_speed(kTop, kTop, all(d), kTop, Parameters{});
    EXPECT_GE(v, before) << d;
    before = v;
  }
}

TEST(SlowedSpeed, BackwardsIsNotScaled) {
  EXPECT_EQ(algo::slowed_speed(-0.3, 0.04, all(0.1), kTop, Parameters{}), -0.3);
  EXPECT_EQ(algo::slowed_speed(-9, 0.04, all(0.1), kTop, Parameters{}), -kTop);
  EXPECT_EQ(algo::slowed_speed(0, 0.04, all(3), kTop, Parameters{}), 0);
}

/// Readings and commands of every kind, among them values that are not numbers.
TEST(SlowedSpeed, KeepsItsLimitsForAnyInput) {
  std::mt19937_64 random(20);
  std::uniform_real_distribution<double> uniform(-1, 5);
  const std::vector<double> odd{kNan, kInf, -kInf, 0, -0.0, 1e300, -1e300};
  const auto draw = [&] {
    return random() % 8 == 0 ? odd[random() % odd.size()] : uniform(random);
  };
  Parameters parameters;
  const auto read = std::to_array<const algo::ParameterInfo*>({&algo::kRingReach,
                                                               &algo::kStopDistance,
                                                               &algo::kSparsenessFactor,
                                                               &algo::kLeastSparseness,
                                                               &algo::kSlowingGain});
  for (int n = 0; n < 20'000; ++n) {
    for (const algo::ParameterInfo* each : read) {
      const double share = std::uniform_real_distribution<double>(0, 1)(random);
      parameters.set(*each, each->min + share * (each->max - each->min));
    }
    RingReadings readings{};
    for (double& d : readings) d = draw();
    const double sparseness = std::uniform_real_distribution<double>(0.01, 1)(random);
    const auto step = algo::sparseness_step(sparseness, readings, kTop, parameters);
    EXPECT_GE(step.next, parameters[algo::kLeastSparseness]);
    EXPECT_LE(step.next, 1);
    const double v_cmd = draw();
    const double v = algo::slowed_speed(v_cmd, step.speed, readings, kTop, parameters);
    ASSERT_TRUE(std::isfinite(v)) << v_cmd;
    EXPECT_LE(std::abs(v), kTop);
    if (std::isfinite(v_cmd)) {
      EXPECT_LE(std::abs(v), std::abs(v_cmd));
      EXPECT_GE(v * v_cmd, 0) << "no sign is reversed";
    }
    EXPECT_LE(v, step.speed);
    EXPECT_EQ(algo::slowed_speed(std::abs(v_cmd), kNan, readings, kTop, parameters), 0);
  }
}

TEST(SlowedSpeed, AllocatesNothing) {
  const Parameters parameters;
  const RingReadings readings = all(1.2);
  const auto before = allocations::count();
  const auto step = algo::sparseness_step(1, readings, kTop, parameters);
  EXPECT_GT(algo::slowed_speed(kTop, step.speed, readings, kTop, parameters), 0);
  EXPECT_EQ(allocations::count(), before);
}

}  // namespace
