// tests/algo/local_localization_test.cpp: dead reckoning from wheels and gyro, worked out by hand.
#include "algo/local_localization.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace {

using algo::LocalLocalization;
using algo::Pose2;

constexpr double kDt = 0.02;  // [s]

TEST(LocalLocalization, DrivesDistancesFromTheWheelsAndTurnsFromTheGyro) {
  LocalLocalization robot;
  robot.reset({1, 2, 0});
  // A quarter turn of 1 m radius in 100 periods; the wheels report a straight line.
  const double quarter = std::numbers::pi / 2;
  for (int k = 0; k < 100; ++k) robot.update({quarter / 100, 0, 0}, quarter / 100 / kDt, kDt);
  EXPECT_NEAR(robot.pose_W().x, 2, 1e-3);
  EXPECT_NEAR(robot.pose_W().y, 3, 1e-3);
  EXPECT_NEAR(robot.pose_W().heading, quarter, 1e-12);
  for (int k = 0; k < 50; ++k) robot.update({-0.01, 0, 0}, 0, kDt);  // and back
  EXPECT_NEAR(robot.pose_W().y, 2.5, 1e-3);
}

TEST(LocalLocalization, LearnsTheBiasWhileTheWheelsStand) {
  LocalLocalization robot;
  robot.reset({});
  constexpr double kBias = 0.03;  // [rad/s]
  for (int k = 0; k < 40; ++k) robot.update({}, kBias, kDt);
  EXPECT_EQ(robot.bias(), 0);  // 0.8 s: not long enough
  for (int k = 0; k < 60; ++k) robot.update({}, kBias, kDt);
  EXPECT_NEAR(robot.bias(), kBias, 1e-12);
  robot.reset({});
  EXPECT_NEAR(robot.bias(), kBias, 1e-12);
  for (int k = 0; k < 500; ++k) robot.update({0.01, 0, 0}, kBias, kDt);
  EXPECT_NEAR(robot.pose_W().heading, 0, 1e-9);
  EXPECT_NEAR(robot.pose_W().x, 5, 1e-9);
}

/// [rad] Heading errors after a minute of turning left and right with 5 % yaw slip.
struct Errors {
  double wheels = 0;
  double fused = 0;
};
Errors after_a_minute(double slip, double bias, double noise) {
  std::mt19937 random(7);
  std::normal_distribution<double> draw(0, 1);
  LocalLocalization robot;
  robot.reset({});
  double truth = 0;
  double wheels = 0;
  for (int k = 0; k < 100; ++k) robot.update({}, bias + noise * draw(random), kDt);  // at rest
  robot.reset({});
  for (int k = 0; k < 3000; ++k) {
    const double rate = 0.3 + 0.5 * std::sin(0.01 * k);  // more left than right
    const double turned = rate * kDt;
    truth += turned;
    wheels += turned / (1 - slip);
    robot.update({0.3 * kDt, 0, turned / (1 - slip)}, rate + bias + noise * draw(random), kDt);
  }
  return {std::abs(algo::wrap_angle(wheels - truth)),
          std::abs(algo::wrap_angle(robot.pose_W().heading - truth))};
}

TEST(LocalLocalization, UnderYawSlipTheHeadingIsBetterThanTheWheelsAlone) {
  const Errors errors = after_a_minute(0.05, 0.01, 0.005);
  EXPECT_GT(errors.wheels, 0.8);  // 5 % of 18 rad
  EXPECT_LT(errors.fused, 0.1);
  EXPECT_LT(errors.fused, errors.wheels / 5);
}

TEST(LocalLocalization, ReportsWheelSlip) {
  LocalLocalization robot;
  robot.reset({});
  const double spinning = 0.5 * kDt;  // [rad] a period, by the wheels; the gyro sees nothing
  for (int k = 0; k < 14; ++k) robot.update({0, 0, spinning}, 0, kDt);
  EXPECT_FALSE(robot.slipping());
  for (int k = 0; k < 3; ++k) robot.update({0, 0, spinning}, 0, kDt);
  EXPECT_TRUE(robot.slipping());
  robot.update({0, 0, spinning}, 0.5, kDt);
  EXPECT_FALSE(robot.slipping());
}

TEST(LocalLocalization, NonFiniteInputsMoveNothing) {
  LocalLocalization robot;
  robot.reset({1, 1, 1});
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  robot.update({kNan, 0, 0}, 0, kDt);
  robot.update({0.1, 0, 0}, kNan, kDt);
  robot.update({0.1, 0, 0}, 0, 0);
  EXPECT_EQ(robot.pose_W(), (Pose2{1, 1, 1}));
}

}  // namespace
