// tests/algo/full_strip/steering_test.cpp: calm turns of the strip's commands.
#include "algo/full_strip/steering.hpp"

#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

namespace {

using algo::CommandCourse;
using algo::followed;
using algo::steadied;
using algo::Twist2;

constexpr double kDt = 0.026;  // [s]

/// The turn rates after each of `wanted` in turn.
std::vector<double> steered(const std::vector<double>& wanted) {
  std::vector<double> out;
  CommandCourse course;
  out.reserve(wanted.size());
  for (const double omega : wanted) {
    course = followed(course, steadied(course, {0.4, omega}, kDt), kDt);
    out.push_back(course.command.omega);
  }
  return out;
}

TEST(Steering, ASteadyTurnIsReachedAndNeverPassed) {
  const auto omega = steered(std::vector<double>(60, 0.8));
  EXPECT_NEAR(omega.back(), 0.8, 1e-6);
  for (std::size_t i = 1; i < omega.size(); ++i) {
    EXPECT_GE(omega[i], omega[i - 1]);
    EXPECT_LE(omega[i], 0.8);
  }
}

TEST(Steering, TremblingAboutATurnIsDamped) {
  std::vector<double> wanted(80);
  for (std::size_t i = 0; i < wanted.size(); ++i) wanted[i] = i % 2 == 0 ? 0.6 : 0.2;
  const auto omega = steered(wanted);
  for (std::size_t i = 40; i < omega.size(); ++i) EXPECT_NEAR(omega[i], 0.4, 0.06);
}

/// A turn of 0.5 rad/s, then one of `other` for a second.
double steered_back(double other) {
  std::vector<double> turns(20, 0.5);
  turns.insert(turns.end(), 40, other);
  return steered(turns).back();
}

TEST(Steering, ASlightTurnToTheOtherSideIsACorrection) {
  EXPECT_NEAR(steered_back(-0.02), -0.02, 1e-3);
  EXPECT_EQ(steered_back(-0.12), -0.04);
}

/// A robot in a narrow lane once drifted into the wall: its corrections were held back.
TEST(Steering, ARealTurnToTheOtherSideIsReached) {
  for (const double other : {-0.15, -0.2, -0.5}) EXPECT_NEAR(steered_back(other), other, 1e-3);
}

TEST(Steering, TheSpeedStaysAsWanted) {
  EXPECT_EQ(steadied({.command = {0.1, 0.2}}, {0.4, 0.3}, kDt).v, 0.4);
}

TEST(Steering, ATurnIsAskedForAsFastAsTheBaseCanGainIt) {
  const algo::MotionLimits limits{.angular_acceleration = 4};
  const CommandCourse course{.command = {0.3, 0.2}};
  EXPECT_DOUBLE_EQ(ramped_turn(course, {0.3, 1}, limits, kDt).omega, 0.2 + 4 * kDt);
  EXPECT_DOUBLE_EQ(ramped_turn(course, {0.3, -1}, limits, kDt).omega, 0.2 - 4 * kDt);
  EXPECT_EQ(ramped_turn(course, {0, 0.25}, limits, kDt), (Twist2{0, 0.25}));
}

TEST(Steering, TheCourseTellsTheChangeOfTheCommand) {
  const CommandCourse course = followed({.command = {0.1, -0.2}}, {0.2, -0.1}, 0.1);
  EXPECT_DOUBLE_EQ(course.rate.v, 1);
  EXPECT_DOUBLE_EQ(course.rate.omega, 1);
  EXPECT_EQ(course.side, -1);
  EXPECT_EQ(followed(course, {}, 0.1).side, -1) << "at rest it keeps the side of its last turn";
}

TEST(Steering, EasedCommandsReachTheWantedOneWithinJerkAndAccelerationAndHardlyPassIt) {
  const algo::MotionLimits limits{
      .acceleration = 0.5, .angular_acceleration = 4, .jerk = 2, .angular_jerk = 20};
  CommandCourse course{.command = {0.1, -0.3}};
  const Twist2 wanted{0.5, 0.6};
  for (int k = 0; k < 120; ++k) {
    const Twist2 next = eased(course, wanted, limits, kDt);
    EXPECT_FALSE(is_hard(course, next, limits, kDt)) << k;
    const Twist2 rate = course.rate;
    course = followed(course, next, kDt);
    EXPECT_LE(std::abs(course.rate.v - rate.v), 2 * kDt * (1 + 1e-9));
    EXPECT_LE(std::abs(course.rate.omega - rate.omega), 20 * kDt * (1 + 1e-9));
    EXPECT_LE(std::abs(course.rate.v), 0.5 + 1e-9);
    EXPECT_LE(std::abs(course.rate.omega), 4 + 1e-9);
    EXPECT_LE(next.v, wanted.v + 2 * kDt * kDt / 4);
    EXPECT_LE(next.omega, wanted.omega + 20 * kDt * kDt / 4);
  }
  EXPECT_NEAR(course.command.v, wanted.v, 1e-6);
  EXPECT_NEAR(course.command.omega, wanted.omega, 1e-6);
}

TEST(Steering, WithoutALimitOfTheJerkNothingIsHard) {
  const algo::MotionLimits limits{.acceleration = 0.5, .angular_acceleration = 4};
  const CommandCourse course{.command = {0.1, -0.3}};
  EXPECT_EQ(eased(course, {0.5, 0.6}, limits, kDt), (Twist2{0.5, 0.6}));
  EXPECT_FALSE(is_hard(course, {0.5, 0.6}, limits, kDt));
  EXPECT_TRUE(is_hard(course, {0.5, -0.3}, {.jerk = 2}, kDt));
}

}  // namespace
