// tests/algo/diff_drive_test.cpp: laws of the differential drive and its refusals.
#include "algo/diff_drive.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

namespace {

using algo::Pose2;
using algo::Twist2;
using algo::WheelSpeeds;

constexpr algo::DriveGeometry kGeometry{0.1, 0.25};

/*       a quarter circle of radius 2 about (0, 2):
 *           (2, 2) heading up
 *          .
 *   (0,0) -> heading right            */
TEST(DiffDrive, QuarterCircle) {
  const Pose2 out = algo::integrate_arc({}, {1.0, 0.5}, std::numbers::pi);  // w t = pi/2, v/w = 2
  EXPECT_NEAR(out.x, 2, 1e-12);
  EXPECT_NEAR(out.y, 2, 1e-12);
  EXPECT_NEAR(out.heading, std::numbers::pi / 2, 1e-12);
}

/// The straight line and the arc agree without a jump, for any turn.
TEST(DiffDrive, SmallTurnsKeepTheirPrecision) {
  for (const double omega : {1e-12, 9.9e-10, 1.1e-9, 1e-8, 1e-6}) {
    const Pose2 out = algo::integrate_arc({}, {1.0, omega}, 1.0);
    EXPECT_NEAR(out.x, 1.0, 1e-12) << omega;
    EXPECT_NEAR(out.y, omega / 2, 1e-9) << omega;  // chord of a small arc: v w t^2 / 2
  }
  EXPECT_NEAR(algo::integrate_arc({}, {1.0, 1e-8}, 1.0).y, 0.5e-8, 1e-16);
}

TEST(DiffDrive, TwoHalvesEqualTheWhole) {
  const Twist2 twist{0.4, -0.9};
  const Pose2 whole = algo::integrate_arc({1, 2, 3}, twist, 0.8);
  const Pose2 halves = algo::integrate_arc(algo::integrate_arc({1, 2, 3}, twist, 0.4), twist, 0.4);
  EXPECT_NEAR(whole.x, halves.x, 1e-12);
  EXPECT_NEAR(whole.y, halves.y, 1e-12);
  EXPECT_NEAR(whole.heading, halves.heading, 1e-12);
}

/// An axle 0.1 m behind R: in a half turn on the spot, R swings about it to the other side.
TEST(DiffDrive, SwingsAboutTheAxle) {
  const Pose2 out = algo::integrate_arc({}, {0, 0.5}, 2 * std::numbers::pi, -0.1);
  EXPECT_NEAR(out.x, -0.2, 1e-12);
  EXPECT_NEAR(out.y, 0, 1e-12);
  const Pose2 straight = algo::integrate_arc({1, 2, 0}, {0.3, 0}, 2, -0.1);
  EXPECT_NEAR(straight.x, 1.6, 1e-12);
  EXPECT_NEAR(straight.y, 2, 1e-12);
}

TEST(DiffDrive, InverseUndoesForward) {
  const Twist2 twist = algo::forward_kinematics(kGeometry, {3, 7});
  EXPECT_NEAR(twist.v, 0.5, 1e-12);      // (0.3 + 0.7) / 2
  EXPECT_NEAR(twist.omega, 0.8, 1e-12);  // 0.4 / 0.5
  const WheelSpeeds back = algo::inverse_kinematics(kGeometry, twist);
  EXPECT_NEAR(back.left, 3, 1e-12);
  EXPECT_NEAR(back.right, 7, 1e-12);
}

TEST(DiffDrive, CountersWrapAround) {
  EXPECT_EQ(algo::count_difference(5, 0xFFFFFFFEU), 7);
  EXPECT_EQ(algo::count_difference(0xFFFFFFFEU, 5), -7);
  EXPECT_EQ(algo::count_difference(100, 40), 60);
  EXPECT_EQ(algo::count_difference(2, 65530, 16), 8);
  EXPECT_EQ(algo::count_difference(65530, 2, 16), -8);
  EXPECT_EQ(algo::count_difference(0x80000000U, 0), -2147483648LL);
  EXPECT_THROW(algo::count_difference(1, 0, 33), std::invalid_argument);
  EXPECT_THROW(algo::count_difference(1, 0, 0), std::invalid_argument);
}

TEST(DiffDrive, CountsOfAWholeTurnOnTheSpot) {
  // Half a track of 0.25 m: for a whole turn each wheel rolls 2 pi 0.25 m = 2.5 wheel turns.
  const Pose2 out = algo::integrate_counts(kGeometry, 1000, {1, 1, 0.5}, {-2500, 2500});
  EXPECT_NEAR(out.x, 1, 1e-12);
  EXPECT_NEAR(out.y, 1, 1e-12);
  EXPECT_NEAR(out.heading, 0.5, 1e-9);
}

TEST(DiffDrive, InvalidNumbersAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {0.0, -0.1, nan}) {
    EXPECT_THROW(algo::forward_kinematics({bad, 0.25}, {}), std::invalid_argument);
    EXPECT_THROW(algo::forward_kinematics({0.1, bad}, {}), std::invalid_argument);
    EXPECT_THROW(algo::inverse_kinematics({bad, 0.25}, {}), std::invalid_argument);
    EXPECT_THROW(algo::integrate_counts({0.1, bad}, 1000, {}, {}), std::invalid_argument);
    EXPECT_THROW(algo::integrate_counts(kGeometry, bad, {}, {}), std::invalid_argument);
  }
  EXPECT_THROW(algo::integrate_arc({}, {}, -0.1), std::invalid_argument);
  EXPECT_THROW(algo::integrate_arc({}, {}, nan), std::invalid_argument);
  EXPECT_EQ(algo::integrate_arc({1, 2, 3}, {1, 1}, 0.0), (Pose2{1, 2, 3}));
}

}  // namespace
