// tests/sim/ground_drive_test.cpp: a robot with floor sensors drives over the ground that it
// masters, and round the rest.
#include "tests/sim/ground_drive.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "algo/units.hpp"

namespace {

using namespace algo::units;
using ground_drive::Drive;
using ground_drive::ramp;
using ground_drive::step;
using ground_drive::trench;

const algo::ClimbLimits kSmall{
    .step_up = 0.015, .step_down = 0.02, .trench = 0.025, .slope_up = 22_deg, .slope_down = 22_deg};

/// 0.6 m before R's origin is the edge.
constexpr double kEdge = 0.6;

TEST(GroundDrive, FlatFloorIsNeverAnAlarm) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Drive drive(kSmall, seed);
    drive.start();
    EXPECT_TRUE(drive.drive_to({2, 0}, 60));
    EXPECT_EQ(drive.surveyed, 0) << "seed " << seed;
  }
}

TEST(GroundDrive, ClimbsWhatItCan) {
  for (const double skew : {0.0, 10_deg, -20_deg}) {
    Drive drive(kSmall);
    drive.add(step(1, algo::compose({kEdge, 0, skew}, {1, 0, 0}), 2, 6, 0.010));
    drive.start();
    EXPECT_TRUE(drive.drive_to({1.6, 0}, 90)) << skew;
    EXPECT_NEAR(drive.highest, 0.010, 1e-9);
    EXPECT_GT(drive.surveyed, 0);
  }
}

/// A step of 3 mm is hardly seen. Once the casters stand on it, the nose is up, and the floor ahead
/// reads farther, as before a trench.
TEST(GroundDrive, TakesNoStepItStandsOnForATrench) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Drive drive(kSmall, seed);
    drive.add(step(1, algo::compose({kEdge, 0, 4_deg}, {1, 0, 0}), 2, 6, 0.0031));
    drive.start();
    EXPECT_TRUE(drive.drive_to({1.6, 0}, 90)) << seed << ' ' << drive.verdict();
  }
}

/// The riser of a high step looks like a slope while the near beam climbs it.
TEST(GroundDrive, RefusesStepsAboveItsLimit) {
  for (const double height : {0.0152, 0.02, 0.025, 0.03, 0.035, 0.04, 0.05, 0.07, 0.1, 0.2}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      Drive drive(kSmall, seed);
      drive.add(step(1, {kEdge + 1, 0, 0}, 2, 20, height));
      drive.start();
      EXPECT_FALSE(drive.drive_to({1.6, 0}, 60));
      EXPECT_EQ(drive.highest, 0) << height << ' ' << drive.verdict();
    }
  }
}

TEST(GroundDrive, NeverDrivesOffAnEdge) {
  for (const double skew : {0.0, 15_deg, 40_deg, 60_deg, 75_deg, -50_deg}) {
    for (const double drop : {0.022, 0.05, 0.9}) {
      Drive drive(kSmall);
      drive.add(step(1, algo::compose({kEdge, 0, skew}, {-1, 0, 0}), 2, 20, drop));
      drive.start();
      EXPECT_FALSE(drive.drive_to({1.6, 0}, 60));
      EXPECT_EQ(drive.deepest, 0) << skew << ' ' << drop << ' ' << drive.verdict();
    }
  }
}

TEST(GroundDrive, CrossesNarrowTrenchesOnly) {
  for (const double width : {0.010, 0.015, 0.020, 0.026, 0.03, 0.05, 0.2}) {
    Drive drive(kSmall);
    drive.add(trench(1, {kEdge + width / 2, 0, 0}, width, 20, 0.05));
    drive.start();
    EXPECT_EQ(drive.drive_to({1.6, 0}, 60), width <= 0.020) << width << ' ' << drive.verdict();
    EXPECT_EQ(drive.deepest > 0, width <= 0.020) << width;
  }
}

TEST(GroundDrive, DrivesUpAndDownARamp) {
  Drive drive(kSmall);
  const double high = std::tan(15_deg);
  drive.add(ramp(1, {kEdge + 0.5, 0, 0}, 1, 4, 0, high));
  drive.add(step(2, {kEdge + 1.5, 0, 0}, 1, 4, high));
  drive.add(ramp(3, {kEdge + 2.5, 0, std::numbers::pi}, 1, 4, 0, high));
  drive.start();
  EXPECT_TRUE(drive.drive_to({4.5, 0}, 200)) << drive.verdict();
}

TEST(GroundDrive, RefusesSteepRamps) {
  Drive up(kSmall);
  up.add(ramp(1, {kEdge + 0.5, 0, 0}, 1, 20, 0, std::tan(24_deg)));
  up.start();
  EXPECT_FALSE(up.drive_to({1.6, 0}, 60)) << up.verdict();
  EXPECT_EQ(up.highest, 0);
  Drive down(kSmall);
  const double high = std::tan(24_deg);
  down.add(step(1, {kEdge - 1, 0, 0}, 2, 20, high));
  down.add(ramp(2, {kEdge + 0.5, 0, std::numbers::pi}, 1, 20, 0, high));
  down.start();
  EXPECT_FALSE(down.drive_to({1.6, 0}, 60)) << down.verdict();
  EXPECT_EQ(down.deepest, 0);
}

/// A step too high, as wide as the robot: any controller goes round it.
TEST(GroundDrive, GoesRoundWhatItCannotClimb) {
  for (const char* controller : {"modified", "vfh"}) {
    Drive drive(kSmall);
    drive.add(step(1, {kEdge + 0.15, 0, 0}, 0.3, 0.3, 0.03));
    drive.start(controller);
    EXPECT_TRUE(drive.drive_to({2.5, 0}, 180)) << controller << ' ' << drive.verdict();
    EXPECT_EQ(drive.highest, 0) << controller;
  }
}

TEST(GroundDrive, StopsADriverByHand) {
  for (const double turn : {0.0, 0.3, -0.3}) {
    Drive drive(kSmall);
    drive.add(step(1, {kEdge - 2, 0, 0}, 4, 20, 0.05));
    drive.start();
    drive.push(1, turn, 30);
    EXPECT_EQ(drive.deepest, 0) << turn << ' ' << drive.verdict();
    EXPECT_EQ(drive.surveyed, 0);
    EXPECT_EQ(drive.t.limit.name, algo::Name("ground"));
  }
}

TEST(GroundDrive, LetsADriverByHandClimb) {
  Drive drive(kSmall);
  drive.add(step(1, {kEdge + 1, 0, 0}, 2, 20, 0.010));
  drive.start();
  drive.push(1, 0, 20);
  EXPECT_NEAR(drive.highest, 0.010, 1e-9);
  EXPECT_GT(drive.pose.x, 1.0);
}

/// The beams end on a wall that the scanner sees: that is no edge.
TEST(GroundDrive, TakesNoWallForAStep) {
  Drive drive(kSmall);
  drive.wall = kEdge;
  drive.add({.id = 1, .pose_W = {kEdge + 0.1, 0, 0}, .shape = algo::Box{0.2, 6}, .height = 1});
  drive.start();
  drive.drive_to({0.35, 0}, 20);
  EXPECT_GT(drive.pose.x, 0.25);
  EXPECT_EQ(drive.surveyed, 0);
}

/// A drop before a wall makes the reading longer, which no wall does.
TEST(GroundDrive, SeesADropBeforeAWall) {
  Drive drive(kSmall);
  drive.wall = kEdge + 0.05;
  drive.add(step(1, {kEdge - 2, 0, 0}, 4, 20, 0.05));
  drive.add({.id = 2, .pose_W = {kEdge + 0.15, 0, 0}, .shape = algo::Box{0.2, 6}, .height = 1});
  drive.start();
  drive.drive_to({0.55, 0}, 20);
  EXPECT_EQ(drive.deepest, 0) << drive.verdict();
}

TEST(GroundDrive, WaitsForSilentSensors) {
  Drive drive(kSmall);
  drive.senses = false;
  drive.start();
  EXPECT_FALSE(drive.drive_to({1, 0}, 5));
  EXPECT_EQ(drive.pose, algo::Pose2{});
  EXPECT_NE(drive.t.words.why.find("silent"), std::string::npos) << drive.t.words.why;
}

}  // namespace
