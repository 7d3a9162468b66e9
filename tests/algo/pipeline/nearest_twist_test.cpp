// tests/algo/pipeline/nearest_twist_test.cpp: the nearest admissible motion, against a search of
// all of them.
#include "algo/pipeline/nearest_twist.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace {

using algo::Twist2;
using Admits = std::function<bool(const Twist2&)>;

constexpr Twist2 kFull{0.5, 1.0};

double far(const Twist2& a, const Twist2& b) {
  return std::hypot((a.v - b.v) / kFull.v, (a.omega - b.omega) / kFull.omega);
}

Twist2 nearest(const Twist2& wanted, const Admits& admits) {
  return algo::nearest_twist(wanted, wanted, kFull, admits);
}

TEST(NearestTwist, AnAdmissibleOnePassesUnchanged) {
  const Twist2 wanted{0.371, -0.123};
  int asked = 0;
  const Twist2 found = nearest(wanted, [&asked](const Twist2&) { return ++asked > 0; });
  EXPECT_EQ(found, wanted);
  EXPECT_EQ(asked, 1);
}

TEST(NearestTwist, NothingIsAdmissibleButRest) {
  int asked = 0;
  const Twist2 found = nearest({0.5, -1}, [&asked](const Twist2&) { return ++asked < 0; });
  EXPECT_EQ(found, Twist2{});
  EXPECT_LE(asked, algo::kMostTwistChecks);
}

TEST(NearestTwist, SlowsAheadToTheLimitAndKeepsTheTurn) {
  const Twist2 found = nearest({0.5, 0.8}, [](const Twist2& t) { return t.v <= 0.17; });
  EXPECT_LE(found.v, 0.17);
  EXPECT_GT(found.v, 0.16);
  EXPECT_EQ(found.omega, 0.8);
}

TEST(NearestTwist, CreepsWhereOnlyLittleIsAdmissible) {
  const Twist2 found = nearest({0.5, 0}, [](const Twist2& t) { return t.v <= 0.02; });
  EXPECT_GT(found.v, 0.012);
}

TEST(NearestTwist, TurnsLessWhereThatIsNearer) {
  const Twist2 found = nearest({0.5, 1}, [](const Twist2& t) { return t.omega <= 0.6; });
  EXPECT_EQ(found.v, 0.5);
  EXPECT_NEAR(found.omega, 0.6, 0.02);
}

struct TwistSet {
  Admits admits{};
  bool island = false;
};

/// A half plane, a disc about rest, or a disc elsewhere, which may be an island.
TwistSet random_set(std::mt19937& random) {
  const auto uniform = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const int kind = std::uniform_int_distribution<int>(0, 2)(random);
  if (kind == 0) {
    const double a = uniform(-1, 1);
    const double b = uniform(-1, 1);
    const double c = uniform(0, 0.6);
    return {[=](const Twist2& t) { return a * t.v / kFull.v + b * t.omega / kFull.omega <= c; }};
  }
  if (kind == 1) {
    const double radius = uniform(0.05, 1);
    return {[=](const Twist2& t) { return far(t, {}) <= radius; }};
  }
  const Twist2 middle{uniform(-0.5, 0.5), uniform(-1, 1)};
  const double radius = uniform(0.2, 0.6);
  return {[=](const Twist2& t) { return far(t, middle) <= radius; }, true};
}

/// The least distance of rest and of the admissible ones among (cells + 1)^2 twists.
double least_on_grid(const Twist2& wanted, const Admits& admits, int cells) {
  double least = far(wanted, {});
  for (int i = 0; i <= cells; ++i) {
    for (int k = 0; k <= cells; ++k) {
      const Twist2 t{wanted.v * i / cells, wanted.omega * k / cells};
      if (admits(t)) least = std::min(least, far(wanted, t));
    }
  }
  return least;
}

TEST(NearestTwist, IsAdmissibleNeverReversedAndHardlyAnyIsNearer) {
  std::mt19937 random(20);
  for (int trial = 0; trial < 3000; ++trial) {
    const TwistSet set = random_set(random);
    const Admits& admits = set.admits;
    std::uniform_real_distribution<double> axis(-1, 1);
    const Twist2 wanted{axis(random) * kFull.v, axis(random) * kFull.omega};
    int asked = 0;
    const Twist2 found = nearest(wanted, [&](const Twist2& t) {
      ++asked;
      return admits(t);
    });
    EXPECT_LE(asked, algo::kMostTwistChecks);
    EXPECT_TRUE(found == Twist2{} || admits(found));
    EXPECT_EQ(found, nearest(wanted, admits)) << "the same again";
    EXPECT_GE(found.v * wanted.v, 0);
    EXPECT_GE(found.omega * wanted.omega, 0);
    EXPECT_LE(std::abs(found.v), std::abs(wanted.v));
    EXPECT_LE(std::abs(found.omega), std::abs(wanted.omega));
    // Nothing on its own grid is nearer. In sets without islands, nothing is by more than a cell, a
    // quarter of the wanted twist in each component.
    EXPECT_LE(far(wanted, found), least_on_grid(wanted, admits, 4) + 1e-12) << trial;
    if (!set.island) {
      EXPECT_LE(far(wanted, found), least_on_grid(wanted, admits, 20) + far(wanted, {}) / 4)
          << trial;
    }
  }
}

/// The base may do less than wanted for another reason, such as a limit for backing blindly.
TEST(NearestTwist, MeasuresFromWantedWithinMost) {
  const Twist2 found = algo::nearest_twist(
      {-0.5, 0.4}, {-0.1, 0.4}, kFull, [](const Twist2& t) { return t.omega < 0.3; });
  EXPECT_EQ(found.v, -0.1);
  EXPECT_NEAR(found.omega, 0.3, 0.02);
}

}  // namespace
