// tests/algo/strip/strip_test.cpp: properties of the force laws, and the units of Eq. 13.
#include "algo/strip/strip.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "algo/strip/elastic_strip_controller.hpp"
#include "algo/strip/strip_law.hpp"
#include "algo/units.hpp"

namespace {

using algo::ForceLaw;
using algo::ForceSettings;
using algo::Vec2;
using namespace algo::units;

constexpr double kReach = 1350_mm;
constexpr double kStep = 200_mm;

TEST(InternalForce, IsZeroOnTheChordWhichGetPosiAlwaysGives) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> anywhere(-5, 5);
  for (int k = 0; k < 100; ++k) {
    const Vec2 start{anywhere(random), anywhere(random)};
    const Vec2 goal{anywhere(random), anywhere(random)};
    const Vec2 via = algo::get_posi(start, goal, 0.1, 1).position();
    const Vec2 end = algo::get_posi(via, goal, 0.1, 1).position();
    EXPECT_LT(algo::internal_force(start, via, end, 0.8).norm(), 1e-14);
  }
}

TEST(InternalForce, PullsABentViaToTheChord) {
  // d1 = d2 = sqrt(2): the middle of the chord is (1, 0), so F = 0.5 ((1, 0) - (1, 1)).
  const Vec2 force = algo::internal_force({0, 0}, {1, 1}, {2, 0}, 0.5);
  EXPECT_LT((force - Vec2(0, -0.5)).norm(), 1e-12);
}

/// The force is minus the gradient of the potential (Eq. 5 and 7).
TEST(ExternalForce, IsTheSlopeOfThePotential) {
  const ForceSettings settings{ForceLaw::Original, kReach, 0.6, kStep};
  constexpr double h = 1e-6;
  for (const double d : {0.2, 0.7, 1.2, 1.4}) {
    const double slope =
        (algo::potential(d + h, kReach, 0.6) - algo::potential(d - h, kReach, 0.6)) / (2 * h);
    EXPECT_NEAR(algo::force_factor(settings, d), -slope, 1e-8) << d;
  }
}

TEST(ExternalForce, PointsAwayAndVanishesOnThePointItself) {
  for (const ForceLaw law :
       {ForceLaw::Original, ForceLaw::Published, ForceLaw::Linear, ForceLaw::C1}) {
    const ForceSettings settings{law, kReach, 0.6, kStep};
    const Vec2 force = algo::external_force(settings, {1, 1}, {1, 2});
    EXPECT_EQ(force.x(), 0);
    EXPECT_LT(force.y(), 0);
    EXPECT_EQ(algo::external_force(settings, {1, 1}, {1, 1}), Vec2(0, 0));
  }
}

/// The second branch of Eq. 13 is a bare number: 0.6 * 2 / (2 - 1.35) = 1.846 without a unit. As
/// millimetres it is 1.8 mm; as metres it would be nine times the strip's step.
TEST(PublishedFactor, TheSecondBranchMeansMillimetres) {
  const double bare = 0.6 * 2.0 / (2.0 - 1.35);
  EXPECT_NEAR(algo::published_factor(2.0, kReach, 0.6), bare * 1_mm, 1e-12);
  EXPECT_GT(bare, 9 * kStep);
  // The pole is cut 10 mm from the reach: 0.6 * 1350 / 10 = 81 mm.
  EXPECT_NEAR(algo::published_factor(kReach, kReach, 0.6), 81_mm, 1e-12);
  // Inside, the first branch is a length already, at most 1 m.
  EXPECT_NEAR(algo::published_factor(0.35, kReach, 0.6), 600_mm, 1e-12);
  EXPECT_EQ(algo::published_factor(0.0, 3.35, 1.0), 1.0);
}

TEST(LinearFactor, IsThePublishedForceWithoutItsSecondBranch) {
  EXPECT_EQ(algo::linear_factor(1.0, kReach, 0.6), algo::published_factor(1.0, kReach, 0.6));
  EXPECT_EQ(algo::linear_factor(kReach, kReach, 0.6), 0);
  EXPECT_EQ(algo::linear_factor(2.0, kReach, 0.6), 0);
}

/// equations.md E.3: continuous with slope -K_r at the reach, positive, monotone, S / 2 there.
TEST(C1Factor, IsSmoothPositiveAndFalling) {
  constexpr double h = 1e-7;
  EXPECT_NEAR(algo::c1_factor(kReach, kReach, 0.6, kStep), kStep / 2, 1e-15);
  const double below = algo::c1_factor(kReach - h, kReach, 0.6, kStep);
  const double at = algo::c1_factor(kReach, kReach, 0.6, kStep);
  const double above = algo::c1_factor(kReach + h, kReach, 0.6, kStep);
  EXPECT_NEAR((at - below) / h, -0.6, 1e-5);
  EXPECT_NEAR((above - at) / h, -0.6, 1e-5);
  double last = 1e9;
  for (double d = 0; d < 10; d += 0.01) {
    const double now = algo::c1_factor(d, kReach, 0.6, kStep);
    EXPECT_GT(now, 0);
    EXPECT_LT(now, last);
    last = now;
  }
  EXPECT_NEAR(algo::c1_factor(8.0, kReach, 0.6, kStep), 2.4_mm, 0.1_mm);
}

TEST(UpdateStrip, WithoutADeltaKeepsTheHeading) {
  const algo::StripUpdate update = algo::update_strip({1, 2, 0.7}, {1.5, 2}, {-0.5, 0});
  EXPECT_EQ(update.updated, (algo::Pose2{1, 2, 0.7}));
  EXPECT_EQ(update.turn, 0);
}

/// Eq. 12: the heading is atan2(Dy, Dx) itself, and the turn is wrapped.
TEST(UpdateStrip, TurnsTheShortWay) {
  const algo::StripUpdate update = algo::update_strip({0, 0, 3.0}, {-1, -0.1}, {0, 0});
  EXPECT_NEAR(update.updated.heading, -std::numbers::pi + std::atan(0.1), 1e-12);
  EXPECT_NEAR(update.turn, 2 * std::numbers::pi + update.updated.heading - 3.0, 1e-12);
}

TEST(GetPosi, NeverPassesTheTarget) {
  EXPECT_EQ(algo::get_posi({0, 0}, {0.05, 0}, 0.1, 1).position(), Vec2(0.05, 0));
  EXPECT_EQ(algo::get_posi({3, 3}, {3, 3}, 0.1, 1), (algo::Pose2{3, 3, 0}));
}

/// The driving law by hand: S 0.2, v_max 0.3, gain 2, w_max 1.
TEST(DriveTo, FollowsTheLaw) {
  const algo::Parameters parameters;
  // Straight ahead, half a step away: half of v_max.
  const algo::Twist2 ahead = algo::drive_to({0, 0, 0}, {0.1, 0}, parameters);
  EXPECT_NEAR(ahead.v, 0.15, 1e-12);
  EXPECT_EQ(ahead.omega, 0);
  // 0.3 rad to the left, two steps away: v_max cos 0.3, 0.6 rad/s.
  const Vec2 left = 0.4 * algo::direction(0.3);
  EXPECT_NEAR(algo::drive_to({}, left, parameters).v, 0.3 * std::cos(0.3), 1e-12);
  EXPECT_NEAR(algo::drive_to({}, left, parameters).omega, 0.6, 1e-12);
  // Behind: turn in place at the limit.
  const algo::Twist2 behind = algo::drive_to({}, {-1, -0.1}, parameters);
  EXPECT_EQ(behind.v, 0);
  EXPECT_EQ(behind.omega, -1);
  EXPECT_EQ(algo::drive_to({1, 1, 1}, {1, 1}, parameters), algo::Twist2{});
}

}  // namespace
