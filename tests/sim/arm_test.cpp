// tests/sim/arm_test.cpp: the arm of a simulated robot: its chain in Bullet, its motors, its limits
// and its contacts, with dynamics and without.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "algo/arm/arm_chain.hpp"
#include "server/run/robot_library.hpp"
#include "sim/bullet_vehicle.hpp"
#include "sim/kinematic_vehicle.hpp"
#include "sim/world.hpp"

namespace sim {
namespace {

using algo::JointValues;

constexpr double kArmTick = 0.026;  // [s]

RobotModel arm_robot(double step_rate = 1000) {
  RobotModel robot = server::builtin_robot("silvermate_arm");
  robot.arm->step_rate = step_rate;
  return robot;
}

/// A vehicle with an arm among obstacles.
template <typename Vehicle>
struct ArmBench {
  explicit ArmBench(const RobotModel& model = arm_robot())
      : robot(model), vehicle(robot, kArmTick), obstacles(robot.hull_high), trail(kArmTick, 0.2) {
    vehicle.reset({});
  }
  void add(const algo::Obstacle& obstacle) {
    obstacles.add(obstacle);
    vehicle.added(obstacle);
  }
  void run(const algo::Twist2& base, const JointValues& rates, double seconds) {
    for (double t = 0; t < seconds - 1e-9; t += kArmTick) {
      vehicle.turn_joints(rates);
      vehicle.drive(base, obstacles, trail);
    }
  }
  const ArmState& arm() const { return vehicle.state().arm; }

  RobotModel robot;
  Vehicle vehicle;
  ObstacleSet obstacles;
  PoseTrail trail;
};
using BulletBench = ArmBench<BulletVehicle>;
using KinematicBench = ArmBench<KinematicVehicle>;

algo::Obstacle shelf(const algo::Vec2& at_W, double bottom, double height) {
  return {.id = 1,
          .pose_W = {at_W.x(), at_W.y(), 0},
          .shape = algo::Box{0.4, 0.4},
          .height = height,
          .bottom = bottom};
}

algo::Pose3 pose_of(const btTransform& at) {
  algo::Pose3 pose = algo::Pose3::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      pose.linear()(row, column) = at.getBasis()[row][column];
    }
    pose.translation()[row] = at.getOrigin()[row];
  }
  return pose;
}

TEST(BulletArm, EveryLinkIsWhereTheChainSays) {
  for (const double elbow_offset : {0.0, 0.04}) {
    RobotModel robot = arm_robot();
    robot.arm->elbow_offset = elbow_offset;
    robot.arm->heading = 0.3;
    BulletBench bench(robot);
    bench.run({0.3, 0.4}, {0.3, -0.4, 0.5, 0.6, -0.7, 0.4, 0.9}, 1.0);
    const algo::MobileArm body = body_of(*robot.arm, robot.radius, robot.hull_high);
    const algo::Pose3 chassis_W = pose_of(bench.vehicle.chassis_W());
    const algo::Pose3 ground_W = chassis_W * Eigen::Translation3d(0, 0, -robot.mass_height);
    const algo::ArmFrames frames = arm_frames(
        body.arm, algo::joints_of(bench.vehicle.arm()->position()), ground_W * body.mount_R);
    for (std::size_t joint = 0; joint <= algo::kArmJoints; ++joint) {
      EXPECT_TRUE(bench.vehicle.arm()->frame_W(joint).isApprox(frames[joint], 1e-12)) << joint;
    }
  }
}

/// The largest error [rad] on sines of 0.5 rad, and after them at rest.
struct Tracking {
  double moving = 0;
  double resting = 0;
};
Tracking track_sines(double step_rate) {
  BulletBench bench(arm_robot(step_rate));
  const JointValues rest = bench.arm().position;
  Tracking worst;
  double time = 0;
  const auto wanted = [&](std::size_t k, double t) {
    const double turn = 2 * std::numbers::pi * (0.4 + 0.06 * static_cast<double>(k));
    return 0.25 * (1 - std::cos(turn * t));
  };
  JointValues rates{};
  for (int n = 0; n < 150; ++n) {
    for (std::size_t k = 0; k < rates.size(); ++k) {
      rates[k] = (wanted(k, time + kArmTick) - wanted(k, time)) / kArmTick;
    }
    bench.run({}, rates, kArmTick);
    time += kArmTick;
    for (std::size_t k = 0; k < rates.size(); ++k) {
      worst.moving =
          std::max(worst.moving, std::abs(bench.arm().position[k] - rest[k] - wanted(k, time)));
    }
  }
  const JointValues there = bench.arm().position;
  bench.run({0.2, 0.1}, {}, 1.0);
  for (std::size_t k = 0; k < rates.size(); ++k) {
    worst.resting =
        std::max(worst.resting, std::abs(bench.arm().position[k] - rest[k] - wanted(k, time)));
  }
  EXPECT_NE(bench.arm().position, there);  // it has settled since
  return worst;
}

TEST(BulletArm, TracksSinesWithinTheFiguresOfItsStepRate) {
  const Tracking slow = track_sines(240);
  EXPECT_LT(slow.moving, 1.1e-2);
  EXPECT_LT(slow.resting, 1e-4);
  const Tracking fast = track_sines(1000);
  EXPECT_LT(fast.moving, 2.6e-3);
  EXPECT_LT(fast.resting, 1e-5);
}

/// A motor at the limit of its torque must not swing past its target, farther each time.
TEST(BulletArm, AStretchedArmKeepsToARateThatChangesItsSign) {
  RobotModel robot = arm_robot();
  robot.arm->start = JointValues{0.8, 1.2, -0.5, 0.7, -0.4, -0.6, -0.3};
  BulletBench bench(robot);
  const double rate = robot.arm->rates[1];
  double fastest = 0;
  for (int n = 0; n < 80; ++n) {
    bench.run({}, {0, (n / 4) % 2 == 0 ? rate : -rate, 0, 0, 0, 0, 0}, kArmTick);
    fastest = std::max(fastest, std::abs(bench.arm().rate[1]));
  }
  EXPECT_LT(fastest, 2 * rate);
  const double there = bench.arm().position[1];
  bench.run({}, {}, 0.2);
  EXPECT_NEAR(bench.arm().position[1], there, 0.08);
  EXPECT_LT(std::abs(bench.arm().rate[1]), 0.1);
}

TEST(BulletArm, SagsUnderAPayloadThatItsMotorsCannotHold) {
  RobotModel strong = arm_robot();
  strong.arm->rest = {0, std::numbers::pi / 2, 0, 0, 0, 0, 0};  // stretched out
  RobotModel weak = strong;
  weak.arm->payload = 5;
  BulletBench holds(strong);
  BulletBench sags(weak);
  for (BulletBench* bench : {&holds, &sags}) bench->run({0.1, 0}, {}, 1.0);
  EXPECT_LT(std::abs(holds.arm().position[1] - std::numbers::pi / 2), 1e-4);
  EXPECT_GT(std::abs(sags.arm().position[1] - std::numbers::pi / 2), 0.05);
}

TEST(BulletArm, ATurningJointStopsAtItsLimit) {
  BulletBench bench;
  bench.run({}, {0, 0, 0, 0, 0, 0, 2}, 3.0);
  EXPECT_NEAR(bench.arm().position[6], bench.robot.arm->limits[6], 1e-3);
  bench.run({}, {0, 0, 0, 0, 0, 0, std::nan("")}, kArmTick);
  EXPECT_NEAR(bench.arm().position[6], bench.robot.arm->limits[6], 1e-3);
}

TEST(BulletArm, AParkedRobotKeepsItsArmBitForBit) {
  BulletBench bench;
  bench.run({}, {0.4, 0, 0, 0, 0, 0, 0}, 0.5);
  bench.run({}, {}, 2.0);
  const JointValues there = bench.arm().position;
  bench.run({}, {}, 1.0);
  EXPECT_EQ(bench.arm().position, there);
}

TEST(BulletArm, TheSameCommandsMoveItTheSame) {
  BulletBench one;
  BulletBench two;
  for (BulletBench* bench : {&one, &two}) {
    bench->add(shelf({0.5, -0.5}, 0.6, 0.9));
    bench->run({0.2, 0.3}, {0.3, -0.4, 0.5, 0.6, -0.7, 0.4, 0.9}, 2.0);
  }
  EXPECT_EQ(one.arm().position, two.arm().position);
  EXPECT_EQ(one.vehicle.state().pose_W, two.vehicle.state().pose_W);
}

/// Stretches the arm out at the robot's right into a shelf.
template <typename Bench>
void reach_into_a_shelf() {
  Bench bench;
  bench.add(shelf({0.0, -0.75}, 0.80, 1.10));
  EXPECT_FALSE(bench.arm().touched);
  bench.run({}, {0.6, 0, 0, 0, 0, 0, 0}, 3.5);
  ASSERT_TRUE(bench.arm().touched);
  EXPECT_NE(*bench.arm().touched, algo::BodyLink::Base);
  EXPECT_FALSE(bench.vehicle.state().contact);
}

TEST(BulletArm, NamesTheLinkThatTouches) {
  reach_into_a_shelf<BulletBench>();
}

TEST(KinematicArm, StopsBeforeWhatItWouldTouchAndNamesTheLink) {
  reach_into_a_shelf<KinematicBench>();
}

TEST(KinematicArm, IntegratesItsRatesWithinItsLimits) {
  KinematicBench bench;
  const JointValues rest = bench.arm().position;
  bench.run({}, {0.5, 0, 0, 0, 0, 0, 9}, kArmTick * 10);
  EXPECT_NEAR(bench.arm().position[0], rest[0] + 0.5 * 0.26, 1e-12);
  EXPECT_NEAR(bench.arm().position[6], bench.robot.arm->rates[6] * 0.26, 1e-12);
  bench.run({}, {0, 0, 0, 0, 0, 0, 9}, 5);
  EXPECT_EQ(bench.arm().position[6], bench.robot.arm->limits[6]);
}

TEST(ObstacleHeights, ABaseDrivesUnderABeamThatItsScannerDoesNotSee) {
  for (const PhysicsKind physics : {PhysicsKind::Bullet, PhysicsKind::Kinematic}) {
    Scenario scenario;
    scenario.robot = server::builtin_robot("silvermate");
    scenario.physics = physics;
    scenario.obstacles = {shelf({1.0, 0}, 0.7, 0.9)};
    World world(scenario, 1);
    algo::Observation seen;
    world.reset(seen);
    std::size_t scans = 0;
    for (int k = 0; k < 150; ++k) {
      world.step({.base = {0.4, 0}}, seen);
      for (const algo::LaserScan& scan : seen.scans) {
        EXPECT_NE(scan.status[scan.size() / 2], algo::Beam::Ok);
        ++scans;
      }
    }
    EXPECT_GT(scans, 10U);
    EXPECT_GT(world.pose_W().x, 1.3);
    EXPECT_FALSE(world.ground_truth()->collided);
  }
}

TEST(ObstacleHeights, AFoldedArmIsInTheWayOfALowBeam) {
  Scenario scenario;
  scenario.robot = arm_robot();
  scenario.obstacles = {shelf({1.0, 0}, 0.7, 1.5)};
  World world(scenario, 1);
  algo::Observation seen;
  world.reset(seen);
  ASSERT_TRUE(seen.joints);
  for (std::size_t i = 0; i < algo::kArmJoints; ++i) {
    EXPECT_NEAR(seen.joints->position[i], scenario.robot.arm->rest[i], 1e-9);
  }
  for (int k = 0; k < 100; ++k) world.step({.base = {0.4, 0}}, seen);
  const auto truth = world.ground_truth();
  EXPECT_TRUE(truth->collided);
  ASSERT_TRUE(truth->touched);
  EXPECT_NE(*truth->touched, algo::BodyLink::Base);
  EXPECT_LE(truth->clearance, 1e-3);
}

}  // namespace
}  // namespace sim
