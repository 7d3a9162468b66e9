// tests/sim/ground_test.cpp: ramps, steps and trenches under a robot with mass.
#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/run/robot_library.hpp"
#include "sim/bullet_vehicle.hpp"
#include "sim/world.hpp"

namespace sim {
namespace {

using algo::Obstacle;
using algo::Pose2;

constexpr double kSlopeDegree = std::numbers::pi / 180;
constexpr double kGroundTick = 0.026;  // [s]

/// Ground from `from` to `to` along x with the heights of its ends.
Obstacle slab(std::uint32_t id, double from, double to, double low, double high) {
  return {.id = id,
          .pose_W = {(from + to) / 2, 0, 0},
          .shape = algo::Ramp{to - from, 4, low},
          .height = high};
}
Obstacle ditch(std::uint32_t id, double from, double to, double depth) {
  return {.id = id, .pose_W = {(from + to) / 2, 0, 0}, .shape = algo::Trench{to - from, 4, depth}};
}
/// A slope of `angle` rising along x from x = 1 for 6 m.
Obstacle hill(double angle) {
  return slab(1, 1, 7, 0, 6 * std::tan(angle));
}

Scenario ground_scenario(const std::string& robot,
                         const std::vector<Obstacle>& ground,
                         const Pose2& start = {}) {
  Scenario scenario;
  scenario.robot = server::builtin_robot(robot);
  scenario.robot.sensors.lasers = {LaserConfig::ideal(0.5)};
  scenario.start = start;
  scenario.obstacles = ground;
  return scenario;
}

class GroundDrive {
 public:
  GroundDrive(const std::string& robot,
              const std::vector<Obstacle>& ground,
              const Pose2& start = {})
      : world(ground_scenario(robot, ground, start), 1) {
    world.reset(seen);
  }
  void run(const algo::Twist2& twist, double seconds) {
    for (double t = 0; t < seconds - 1e-9; t += kGroundTick) world.step({twist}, seen);
  }
  const VehicleState& state() const { return world.state(); }

  World world;
  algo::Observation seen{};
};

TEST(Ground, ARobotClimbsARampAndTiltsWithIt) {
  GroundDrive drive("jackal", {hill(10 * kSlopeDegree)});
  EXPECT_NEAR(drive.state().z, 0, 1e-3);
  drive.run({0.5, 0}, 6);  // to x = 3 or so
  const VehicleState& state = drive.state();
  ASSERT_GT(state.pose_W.x, 2);
  EXPECT_NEAR(state.z, (state.pose_W.x - 1) * std::tan(10 * kSlopeDegree), 2e-3);
  EXPECT_NEAR(state.pitch, -10 * kSlopeDegree, 0.1 * kSlopeDegree);  // nose up
  EXPECT_NEAR(state.roll, 0, 0.1 * kSlopeDegree);
  EXPECT_NEAR(state.pose_W.y, 0, 5e-3);
  EXPECT_FALSE(state.contact);
  const auto truth = drive.world.ground_truth();
  ASSERT_TRUE(truth && truth->tilt);
  EXPECT_EQ(*truth->tilt, state.tilt());
  EXPECT_TRUE(std::isinf(truth->clearance));  // a ramp is no obstacle
  EXPECT_FALSE(truth->collided);
}

TEST(Ground, ARobotStandsStillOnASlope) {
  for (const double heading : {0.0, 0.7, 1.57, 3.1}) {
    GroundDrive drive("jackal", {hill(15 * kSlopeDegree)}, {4, 0.3, heading});
    const VehicleState before = drive.state();
    EXPECT_EQ(before.pose_W.x, 4);  // exactly at the start
    EXPECT_EQ(before.pose_W.heading, heading);
    EXPECT_NEAR(before.z, 3 * std::tan(15 * kSlopeDegree), 2e-3) << heading;
    EXPECT_NEAR(std::cos(before.roll) * std::cos(before.pitch), std::cos(15 * kSlopeDegree), 1e-3);
    drive.run({}, 30);
    EXPECT_NEAR(drive.state().pose_W.x, 4, 1e-3) << heading;
    EXPECT_NEAR(drive.state().pose_W.y, 0.3, 1e-3) << heading;
  }
}

TEST(Ground, OdometryCountsTheWayOnTheMap) {
  GroundDrive drive("jackal", {hill(15 * kSlopeDegree)}, {2, 0, 0});
  drive.run({0.5, 0}, 6);
  ASSERT_GT(drive.state().pose_W.x, 4.5);
  EXPECT_NEAR(drive.seen.odometry.pose.x, drive.state().pose_W.x, 0.02);
  // The encoders stay raw: they count the way along the slope.
  const RobotModel robot = server::builtin_robot("jackal");
  const double wheel_way =
      drive.seen.encoders->left / robot.counts_per_turn * 2 * std::numbers::pi * robot.wheel_radius;
  EXPECT_NEAR(wheel_way * std::cos(15 * kSlopeDegree), drive.state().pose_W.x - 2, 0.02);
}

TEST(Ground, ALowStepIsClimbedAndAHighOneStopsTheHull) {
  GroundDrive low("robhaz", {slab(1, 1, 5, 0.02, 0.02)});
  low.run({0.3, 0}, 8);
  EXPECT_GT(low.state().pose_W.x, 1.8);
  EXPECT_NEAR(low.state().z, 0.02, 2e-3);
  GroundDrive high("jackal", {slab(1, 1, 5, 0.3, 0.3)});
  bool touched = false;
  for (int tick = 0; tick < 300; ++tick) {
    high.run({0.3, 0}, kGroundTick);
    touched = touched || high.world.ground_truth()->collided;
  }
  EXPECT_TRUE(touched);  // its upright end is higher than the hull's low edge
  EXPECT_LT(high.state().pose_W.x, 0.75);
  EXPECT_NEAR(high.state().z, 0, 0.02);
  // The tracks of this one reach ahead of its hull: it stands before the step, untouched.
  GroundDrive tracks("robhaz", {slab(1, 1, 5, 0.3, 0.3)});
  tracks.run({0.3, 0}, 8);
  EXPECT_NEAR(tracks.state().pose_W.x, 0.61, 0.005);
  EXPECT_NEAR(tracks.state().z, 0, 2e-3);
}

TEST(Ground, ANarrowTrenchIsCrossedAndAWideOneIsAFall) {
  GroundDrive narrow("robhaz", {ditch(1, 1, 1.05, 0.3)});
  narrow.run({0.3, 0}, 8);
  EXPECT_GT(narrow.state().pose_W.x, 1.8);
  EXPECT_NEAR(narrow.state().z, 0, 2e-3);
  EXPECT_FALSE(narrow.world.ground_truth()->fallen);
  GroundDrive wide("robhaz", {ditch(1, 1, 3, 0.5)});
  wide.run({0.3, 0}, 8);
  EXPECT_TRUE(wide.world.ground_truth()->fallen);
  EXPECT_LT(wide.state().z, -0.1);
}

TEST(Ground, DrivingOffAPlatformIsAFallAndResetRightsTheRobot) {
  GroundDrive drive("jackal", {slab(1, -3, 1, 0.4, 0.4)});
  EXPECT_NEAR(drive.state().z, 0.4, 2e-3);
  EXPECT_FALSE(drive.world.ground_truth()->fallen);
  drive.run({1.0, 0}, 4);
  EXPECT_TRUE(drive.world.ground_truth()->fallen);
  drive.world.reset(drive.seen);
  EXPECT_FALSE(drive.world.ground_truth()->fallen);
  EXPECT_NEAR(drive.state().z, 0.4, 2e-3);
  EXPECT_EQ(drive.state().pose_W.x, 0);
}

TEST(Ground, TheScanOfATiltedRobotMeetsFloorAndRamp) {
  // On the level, 1 m before a slope of 10 degrees: the plane of the scan meets it where the slope
  // is as high.
  GroundDrive level("jackal", {hill(10 * kSlopeDegree)});
  const double height = 0.3;
  const algo::LaserScan& scan = level.seen.scans[0];
  const std::size_t ahead = scan.size() / 2;
  EXPECT_NEAR(scan.ranges[ahead], 1 + height / std::tan(10 * kSlopeDegree), 0.02);
  EXPECT_EQ(scan.status[0], algo::Beam::Free);  // nothing beside it
  // On the slope, looking down: the beam ahead meets the floor.
  GroundDrive down("jackal", {hill(10 * kSlopeDegree)}, {4, 0, std::numbers::pi});
  const algo::LaserScan& floor = down.seen.scans[0];
  const double above = 3 * std::tan(10 * kSlopeDegree) + height * std::cos(10 * kSlopeDegree);
  ASSERT_EQ(floor.status[ahead], algo::Beam::Ok);
  EXPECT_NEAR(floor.ranges[ahead], above / std::sin(10 * kSlopeDegree), 0.05);
  // Looking up the slope, it sees nothing of it.
  GroundDrive up("jackal", {hill(10 * kSlopeDegree)}, {3, 0, 0});
  EXPECT_EQ(up.seen.scans[0].status[ahead], algo::Beam::Free);
}

TEST(Ground, AnObstacleIsSeenAsOnTheLevelIfTheGroundIsFarAway) {
  Obstacle post{.id = 1, .pose_W = {3, 0.4, 0.2}, .shape = algo::Box{0.5, 0.8}};
  GroundDrive level("jackal", {post});
  GroundDrive uneven("jackal", {post, slab(2, 40, 41, 0, 0.1)});
  const algo::LaserScan& a = level.seen.scans[0];
  const algo::LaserScan& b = uneven.seen.scans[0];
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a.status[i], b.status[i]) << i;
    if (a.status[i] == algo::Beam::Ok) {
      EXPECT_NEAR(a.ranges[i], b.ranges[i], 2e-3) << i;
    }
  }
}

TEST(Ground, RefusesWhatCannotBe) {
  GroundDrive drive("jackal", {slab(1, 2, 3, 0, 0.1)});
  const auto edit = [&](const algo::Request& request) {
    return drive.world.edit(request).value_or("");
  };
  EXPECT_EQ(edit(algo::AddObstacle{slab(2, -1, 1, 0.1, 0.1)}),
            "Obstacle 2 would be under the robot.");
  EXPECT_EQ(edit(algo::AddObstacle{ditch(2, 0.1, 0.3, 0.1)}),
            "Obstacle 2 would be under the robot.");
  EXPECT_EQ(edit(algo::MoveObstacle{1, {0, 0, 0}}), "Obstacle 1 would be under the robot.");
  EXPECT_EQ(edit(algo::AddObstacle{ditch(2, 4, 5, 0.1)}), "");
  EXPECT_EQ(edit(algo::RemoveObstacle{1}), "");
  EXPECT_EQ(edit(algo::RemoveObstacle{2}), "");
  EXPECT_FALSE(drive.world.ground_truth()->tilt);  // level again
  GroundDrive on("jackal", {slab(1, -1, 1, 0.1, 0.1)});
  EXPECT_EQ(on.world.edit(algo::RemoveObstacle{1}), "Obstacle 1 is under the robot.");
  EXPECT_EQ(on.world.edit(algo::MoveObstacle{1, {0.1, 0, 0}}), "Obstacle 1 is under the robot.");
  Scenario kinematic = ground_scenario("jackal", {slab(1, 2, 3, 0, 0.1)});
  kinematic.physics = PhysicsKind::Kinematic;
  try {
    const World world(kinematic, 1);
    FAIL() << "a kinematic robot cannot climb";
  } catch (const std::invalid_argument& e) {
    EXPECT_STREQ(e.what(), "Obstacle 1: a ramp or trench needs physics bullet.");
  }
}

TEST(Ground, SameCommandsSameRunBitForBit) {
  const std::vector<Obstacle> ground{hill(8 * kSlopeDegree), ditch(2, 0.6, 0.63, 0.1)};
  GroundDrive a("masuda", ground);
  GroundDrive b("masuda", ground);
  for (int k = 0; k < 400; ++k) {
    const algo::Twist2 twist{0.3, 0.2 * std::sin(0.05 * k)};
    a.run(twist, kGroundTick);
    b.run(twist, kGroundTick);
    ASSERT_EQ(a.state().pose_W, b.state().pose_W) << k;
    ASSERT_EQ(a.state().tilt(), b.state().tilt()) << k;
    ASSERT_EQ(a.seen.scans[0].ranges, b.seen.scans[0].ranges) << k;
  }
  EXPECT_GT(a.state().z, 0.05);
}

}  // namespace
}  // namespace sim
