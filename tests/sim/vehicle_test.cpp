// tests/sim/vehicle_test.cpp: the figures of the vehicle models and of their shared arithmetic.
#include "sim/vehicle.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "server/run/robot_library.hpp"
#include "sim/bullet_vehicle.hpp"
#include "sim/kinematic_vehicle.hpp"
#include "sim/world.hpp"

namespace sim {
namespace {

using algo::Pose2;
using algo::Twist2;

constexpr double kPeriod = 0.026;

TEST(Substeps, AreEqualAndNeverSlowerThan240Hertz) {
  EXPECT_EQ(Substeps(0.026).count, 7u);  // 240 * 0.026 = 6.24
  EXPECT_NEAR(Substeps(0.026).length, 0.003714, 1e-6);
  EXPECT_EQ(Substeps(0.025).count, 6u);
  EXPECT_EQ(Substeps(0.001).count, 1u);
}

TEST(WithinLimits, KeepsTheCurvatureAndRejectsNan) {
  const RobotModel robot = server::builtin_robot("silvermate");  // 0.5 m/s, 1 rad/s
  EXPECT_EQ(within_limits({0.4, -0.9}, robot), (Twist2{0.4, -0.9}));
  const Twist2 fast = within_limits({1.0, 0.5}, robot);
  EXPECT_NEAR(fast.v, 0.5, 1e-12);
  EXPECT_NEAR(fast.omega, 0.25, 1e-12);
  const Twist2 turning = within_limits({-0.4, -4}, robot);
  EXPECT_NEAR(turning.v, -0.1, 1e-12);
  EXPECT_NEAR(turning.omega, -1, 1e-12);
  EXPECT_EQ(within_limits({std::nan(""), 0.5}, robot), (Twist2{0, 0.5}));
}

/// A Bullet vehicle with nothing around, driven tick by tick.
class Track {
 public:
  explicit Track(const std::string& name, double period = kPeriod)
      : robot(server::builtin_robot(name)),
        period_(period),
        vehicle(robot, period),
        trail(Substeps(period).length, 0.2) {
    vehicle.reset({});
  }
  void run(const Twist2& command, double seconds) {
    for (double t = 0; t < seconds - 1e-9; t += period_) vehicle.drive(command, obstacles, trail);
  }
  void place(const algo::Obstacle& obstacle) {
    obstacles.add(obstacle);
    vehicle.added(obstacle);
  }
  const VehicleState& state() const { return vehicle.state(); }

  const RobotModel robot;

 private:
  double period_ = 0;

 public:
  BulletVehicle vehicle;
  ObstacleSet obstacles{};
  PoseTrail trail;
};

struct Speed {
  std::string robot{};
  Twist2 command{};
  double tolerance = 0.005;
};
class BulletSpeeds : public testing::TestWithParam<Speed> {};

TEST_P(BulletSpeeds, DrivesAsCommanded) {
  const Speed& speed = GetParam();
  Track track(speed.robot);
  track.run(speed.command, 3);
  const Pose2 before = track.state().pose_W;
  double turned = 0;
  double way = 0;
  Pose2 last = before;
  constexpr int kTicks = 100;
  for (int i = 0; i < kTicks; ++i) {
    track.vehicle.drive(speed.command, track.obstacles, track.trail);
    const Pose2 now = track.state().pose_W;
    turned += algo::wrap_angle(now.heading - last.heading);
    const double middle = last.heading + algo::wrap_angle(now.heading - last.heading) / 2;
    way += (now.position() - last.position()).dot(algo::direction(middle));
    last = now;
  }
  EXPECT_NEAR(way / (kTicks * kPeriod),
              speed.command.v,
              speed.tolerance * std::abs(speed.command.v) + 1e-4);
  EXPECT_NEAR(turned / (kTicks * kPeriod),
              speed.command.omega,
              speed.tolerance * std::abs(speed.command.omega) + 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Robots,
                         BulletSpeeds,
                         testing::Values(Speed{"silvermate", {0.5, 0}},
                                         Speed{"silvermate", {0.5, 1.0}},
                                         Speed{"silvermate", {0.25, -0.5}},
                                         Speed{"silvermate", {0, 1.0}},
                                         Speed{"silvermate", {-0.3, 0.3}},
                                         Speed{"masuda", {0.3, 0.5}},
                                         Speed{"jackal", {1.0, 1.0}},
                                         Speed{"robhaz", {0.8, 0.5}}));

/// The drive wheels of masuda are 9 cm behind R, so that R swings to a side in a turn.
TEST(BulletVehicle, OdometryKnowsWhereTheAxleIs) {
  for (const PhysicsKind physics : {PhysicsKind::Bullet, PhysicsKind::Kinematic}) {
    Scenario scenario;
    scenario.robot = server::builtin_robot("masuda");
    scenario.physics = physics;
    World world(scenario, 1);
    algo::Observation observation;
    world.reset(observation);
    for (int k = 0; k < 300; ++k) world.step({.base = {0.1, 0.4}}, observation);
    const Pose2 truth = world.pose_W();
    EXPECT_LT((observation.odometry.pose.position() - truth.position()).norm(), 0.02);
    EXPECT_LT(truth.position().norm(), 0.6);
    // The axle's middle moves without slip: on a circle of 0.25 m about its left.
    const algo::Vec2 axle_W = algo::to_parent(truth, {-0.09, 0});
    EXPECT_NEAR((axle_W - algo::Vec2(-0.09, 0.25)).norm(), 0.25, 0.01);
  }
}

TEST(BulletVehicle, AcceleratesWithinItsLimits) {
  Track track("silvermate");
  double v = 0;
  double omega = 0;
  double largest_v = 0;
  double largest_omega = 0;
  for (int i = 0; i < 60; ++i) {
    track.vehicle.drive({0.5, 1.0}, track.obstacles, track.trail);
    largest_v = std::max(largest_v, (track.state().twist.v - v) / kPeriod);
    largest_omega = std::max(largest_omega, (track.state().twist.omega - omega) / kPeriod);
    v = track.state().twist.v;
    omega = track.state().twist.omega;
    // 0.5 m/s2: 0.013 m/s a tick from rest, within 2 % and a millimetre a second.
    const double expected = std::min(0.5, 0.013 * (i + 1));
    EXPECT_NEAR(v, expected, 0.02 * expected + 0.004) << "tick " << i;
  }
  EXPECT_LT(largest_v, 0.5 * 1.25);
  EXPECT_GT(largest_v, 0.5 * 0.9);
  EXPECT_LT(largest_omega, 4 * 1.25);
  EXPECT_GT(largest_omega, 4 * 0.9);
}

TEST(BulletVehicle, StopsAndThenDoesNotMoveAtAll) {
  Track track("silvermate");
  track.run({0.5, 0.4}, 3);
  track.run({0, 0}, 2.5);
  EXPECT_EQ(track.state().twist, Twist2{});
  const Pose2 stopped = track.state().pose_W;
  track.run({0, 0}, 60);
  EXPECT_EQ(track.state().pose_W, stopped);
  // A robot at rest can start again.
  track.run({0.2, 0}, 1);
  EXPECT_NEAR(track.state().twist.v, 0.2, 0.004);
}

TEST(BulletVehicle, HaltSkipsTheRamp) {
  Track track("silvermate");
  track.run({0.5, 0}, 3);
  track.vehicle.halt();
  const double x = track.state().pose_W.x;
  track.run({0, 0}, 1);
  EXPECT_LT(track.state().pose_W.x - x, 0.05);  // with the ramp it would be 0.25 m
}

TEST(BulletVehicle, StartsExactlyAtTheStart) {
  Track track("silvermate");
  const Pose2 start{1.25, -3.5, 2.2};
  track.vehicle.reset(start);
  EXPECT_EQ(track.state().pose_W, start);
  track.vehicle.drive({0, 0}, track.obstacles, track.trail);
  EXPECT_EQ(track.state().pose_W, start);
  track.run({0.5, 0}, 2);
  // Straight on along its heading.
  const algo::Vec2 way = track.state().pose_W.position() - start.position();
  EXPECT_NEAR(std::atan2(way.y(), way.x()), 2.2, 0.003);
}

TEST(BulletVehicle, BumperReportsAWallAndTheWallHolds) {
  Track track("silvermate");
  //  robot r 0.35 ->      | wall face at x = 1.0
  track.place({.id = 1, .pose_W = {1.05, 0, std::numbers::pi / 2}, .shape = algo::Wall{4, 0.1}});
  track.run({0.5, 0}, 1);  // 0.25 m on
  EXPECT_FALSE(track.state().contact);
  track.run({0.5, 0}, 2);
  EXPECT_TRUE(track.state().contact);
  EXPECT_NEAR(track.state().pose_W.x, 0.65, 0.005);
  EXPECT_LT(std::abs(track.state().twist.v), 0.05);
  track.run({-0.3, 0}, 1.5);
  EXPECT_FALSE(track.state().contact);
}

TEST(BulletVehicle, WheelsSlipAgainstAWall) {
  Track track("silvermate");
  track.place({.id = 1, .pose_W = {1, 0, 0}, .shape = algo::Box{0.5, 2}});
  track.run({0.5, 0}, 4);
  // The wheels turned for 4 s less half the ramp of 1 s: (4 - 0.5) 0.5 m = 1.75 m; the robot got
  // as far as 0.75 - 0.35 = 0.4 m.
  const double rolled = track.state().left_angle * track.robot.wheel_radius;
  EXPECT_NEAR(rolled, 1.75, 0.02);
  EXPECT_NEAR(track.state().pose_W.x, 0.40, 0.01);
}

TEST(BulletVehicle, PolygonsAndCylindersAreSolidToo) {
  for (const algo::Shape& shape :
       {algo::Shape(algo::Cylinder{0.3}),
        algo::Shape(algo::Polygon{{{-0.3, -1}, {0.3, -1}, {0.3, 1}, {-0.3, 1}}})}) {
    Track track("silvermate");
    track.place({.id = 1, .pose_W = {1.3, 0, 0}, .shape = shape});
    track.run({0.4, 0}, 4);
    EXPECT_TRUE(track.state().contact);
    EXPECT_NEAR(track.state().pose_W.x, 0.65, 0.006);
  }
}

TEST(BulletVehicle, FindsObstaclesThatWereFarAwayAtTheStart) {
  Track track("silvermate");
  track.place({.id = 1, .pose_W = {5, 0, 0}, .shape = algo::Cylinder{0.3}});
  track.run({0.5, 0}, 11);
  EXPECT_TRUE(track.state().contact);
  EXPECT_NEAR(track.state().pose_W.x, 4.35, 0.01);
}

TEST(BulletVehicle, SameCommandsSameBits) {
  const auto drive = [] {
    Track track("silvermate");
    track.place({.id = 1, .pose_W = {1, 0.3, 0}, .shape = algo::Cylinder{0.3}});
    track.run({0.5, 0.1}, 3);
    track.run({0.3, -0.6}, 3);
    return track.state().pose_W;
  };
  EXPECT_EQ(drive(), drive());
}

TEST(KinematicVehicle, DrivesTheExactArc) {
  const RobotModel robot = server::builtin_robot("silvermate");
  KinematicVehicle vehicle(robot, 0.05);
  PoseTrail trail(Substeps(0.05).length, 0.2);
  const ObstacleSet nothing;
  vehicle.reset({});
  for (int i = 0; i < 40; ++i) vehicle.drive({0.4, 0.8}, nothing, trail);
  // 2 s at radius 0.5 m, 1.6 rad: x = 0.5 sin 1.6, y = 0.5 (1 - cos 1.6).
  EXPECT_NEAR(vehicle.state().pose_W.x, 0.5 * std::sin(1.6), 1e-12);
  EXPECT_NEAR(vehicle.state().pose_W.y, 0.5 * (1 - std::cos(1.6)), 1e-12);
  EXPECT_NEAR(vehicle.state().pose_W.heading, 1.6, 1e-12);
  EXPECT_EQ(trail.back(0), vehicle.state().pose_W);
}

TEST(KinematicVehicle, RampsOnlyIfConfigured) {
  const RobotModel robot = server::builtin_robot("silvermate");
  const ObstacleSet nothing;
  PoseTrail trail(Substeps(0.05).length, 0.2);
  KinematicVehicle plain(robot, 0.05);
  plain.reset({});
  plain.drive({0.5, 1}, nothing, trail);
  EXPECT_EQ(plain.state().twist, (Twist2{0.5, 1}));
  KinematicVehicle with_ramps(robot, 0.05, true);
  with_ramps.reset({});
  with_ramps.drive({0.5, 1}, nothing, trail);
  EXPECT_NEAR(with_ramps.state().twist.v, 0.5 * 0.05, 1e-12);
  EXPECT_NEAR(with_ramps.state().twist.omega, 4 * 0.05, 1e-12);
}

TEST(KinematicVehicle, RefusesToMoveIntoAnObstacleButTurnsAndLeaves) {
  const RobotModel robot = server::builtin_robot("silvermate");
  KinematicVehicle vehicle(robot, 0.1);
  PoseTrail trail(Substeps(0.1).length, 0.2);
  ObstacleSet obstacles;
  obstacles.add({.id = 1, .pose_W = {1, 0, 0}, .shape = algo::Cylinder{0.3}});
  vehicle.reset({});
  // Room: 1 - 0.3 - 0.35 = 0.35 m, that is 7 steps of 0.05 m less rounding.
  for (int i = 0; i < 20; ++i) vehicle.drive({0.5, 0}, obstacles, trail);
  EXPECT_TRUE(vehicle.state().contact);
  EXPECT_EQ(vehicle.state().twist.v, 0);
  EXPECT_GT(vehicle.state().pose_W.x, 0.299);
  EXPECT_LT(vehicle.state().pose_W.x, 0.3501);
  const Pose2 held = vehicle.state().pose_W;
  vehicle.drive({0.5, 1}, obstacles, trail);
  EXPECT_EQ(vehicle.state().pose_W.x, held.x);
  EXPECT_NEAR(vehicle.state().pose_W.heading, 0.1, 1e-12);
  vehicle.drive({-0.5, 0}, obstacles, trail);
  EXPECT_FALSE(vehicle.state().contact);
  EXPECT_LT(vehicle.state().pose_W.x, held.x);
}

}  // namespace
}  // namespace sim
