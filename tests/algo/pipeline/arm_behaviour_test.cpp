// tests/algo/pipeline/arm_behaviour_test.cpp: joints and hand under the pipeline's hold, limits and
// guard.
#include "algo/pipeline/arm_behaviour.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "algo/diff_drive.hpp"
#include "algo/gate.hpp"
#include "algo/pipeline/pipeline.hpp"

namespace {

using algo::Command;
using algo::JointValues;
using algo::Obstacle;
using algo::Pipeline;
using algo::Telemetry;

constexpr double kArmWorldTick = 0.05;  // [s]

algo::RobotSpec arm_spec() {
  algo::RobotSpec spec;
  spec.name = "arm";
  spec.radius = 0.35;
  spec.half_track = 0.25;
  spec.period = kArmWorldTick;
  spec.max_v = 0.5;
  spec.max_omega = 1;
  spec.max_acceleration = 0.5;
  spec.max_angular_acceleration = 4;
  spec.drives = true;
  spec.arm.emplace();
  return spec;
}

/// A robot that moves as commanded, with a scanner that sees nothing.
struct ArmWorld {
  explicit ArmWorld(std::vector<Obstacle> declared = {}, const algo::RobotSpec& made = arm_spec())
      : spec(made), pipeline({.declared = std::move(declared)}, made), q(made.arm->rest) {
    pipeline.reset({});
  }
  const Telemetry& tick(std::vector<algo::Request> requests = {}) {
    t.requests.clear();
    for (const algo::Request& request : requests) t.requests.push_back(request);
    if (pipeline.plan_ready()) t.requests.push_back(algo::TakePlan{});
    algo::Observation& o = t.observation;
    o.clear_sensors();
    o.stamp = kArmWorldTick * static_cast<double>(ticks++);
    o.odometry = {o.stamp, pose, t.command.base};
    algo::LaserScan& scan = o.scans.append();
    scan.stamp = o.stamp;
    scan.range_max = 8;
    scan.angle_increment = 0.01;
    scan.resize(10);
    for (std::size_t i = 0; i < scan.size(); ++i) scan.set_free(i);
    if (reports) o.joints = algo::JointReading{o.stamp, q, rates};
    pipeline.tick(t);
    pose = algo::integrate_arc(pose, t.command.base, kArmWorldTick);
    for (std::size_t k = 0; k < q.size(); ++k) {
      rates[k] = t.command.joint_rates[k];
      q[k] += kArmWorldTick * rates[k];
    }
    return t;
  }
  void run(double seconds) {
    for (double s = 0; s < seconds; s += kArmWorldTick) tick();
  }
  double room() const {
    const algo::MobileArm body = mobile_arm(*spec.arm, spec.radius);
    std::vector<algo::Solid> solids;
    for (const Obstacle& o : pipeline_declared) append_solids(o, solids);
    const auto frames = body_frames(body, algo::body_joints(pose, algo::joints_of(q)));
    return clearance(body, frames, solids).smallest();
  }

  algo::RobotSpec spec;
  Pipeline pipeline;
  std::vector<Obstacle> pipeline_declared{};
  JointValues q;
  JointValues rates{};
  algo::Pose2 pose{};
  bool reports = true;
  std::size_t ticks = 0;
  Telemetry t{};
};

Obstacle shelf_at_the_right() {
  return {
      .id = 1, .pose_W = {0, -0.8, 0}, .shape = algo::Box{0.6, 0.4}, .height = 1.2, .bottom = 0.8};
}

bool command_rests(const Command& command) {
  return command.base == algo::Twist2{} && command.joint_rates == Command{}.joint_rates;
}

TEST(ArmPipeline, JointsGoStraightToTheirPositionsAndRestThere) {
  ArmWorld world;
  EXPECT_TRUE(command_rests(world.tick().command));
  EXPECT_EQ(world.t.command.joints, algo::kArmJoints);
  JointValues goal = world.q;
  goal[0] += 0.4;
  goal[6] -= 1.0;
  world.tick({algo::SetJoints{goal}});
  EXPECT_EQ(world.t.arm.state, algo::ArmState::Turns);
  EXPECT_EQ(world.t.words.what, "Turning the joints");
  // All arrive at once, and the slowest joint at its limit.
  EXPECT_NEAR(world.t.command.joint_rates[0] / world.t.command.joint_rates[6], -0.4, 1e-9);
  for (std::size_t k = 0; k < algo::kArmJoints; ++k) {
    EXPECT_LE(std::abs(world.t.command.joint_rates[k]), world.spec.arm->rates[k] + 1e-12);
  }
  world.run(3);
  EXPECT_EQ(world.t.arm.state, algo::ArmState::Arrived);
  for (std::size_t k = 0; k < algo::kArmJoints; ++k) EXPECT_NEAR(world.q[k], goal[k], 2e-3);
}

TEST(ArmPipeline, EveryHoldHoldsTheJoints) {
  ArmWorld world;
  JointValues goal = world.q;
  goal[6] = 1.5;
  world.tick({algo::SetJoints{goal}});
  EXPECT_FALSE(command_rests(world.t.command));
  world.tick({algo::Stop{true}});
  EXPECT_EQ(world.t.hold, algo::holds::kStopped);
  EXPECT_TRUE(command_rests(world.t.command));
  world.tick({algo::Stop{false}});
  EXPECT_FALSE(command_rests(world.t.command));
  world.reports = false;
  world.tick();
  EXPECT_EQ(world.t.hold, algo::holds::kNoJoints);
  EXPECT_TRUE(command_rests(world.t.command));
  world.reports = true;
  world.q[3] = std::numeric_limits<double>::quiet_NaN();
  world.tick();
  EXPECT_EQ(world.t.hold, algo::holds::kNotFinite);
  EXPECT_TRUE(command_rests(world.t.command));
}

TEST(ArmPipeline, GoalsThatCannotBeAreRefusedInWords) {
  ArmWorld world;
  JointValues goal{};
  goal[1] = 3;
  const auto joints = world.pipeline.refusal(algo::SetJoints{goal});
  EXPECT_EQ(joints.value_or("").substr(0, 25), "Joint 2 must lie within 2");
  algo::SetHandGoal hand;
  hand.attitude_W = {0.5, 0, 0, 0};
  EXPECT_EQ(world.pipeline.refusal(hand).value_or(""),
            "The hand's attitude must be a unit quaternion.");
  hand.attitude_W = {};
  EXPECT_FALSE(world.pipeline.refusal(hand));
  hand.path_W = {{0, 20, 1}, {0, 0, 1}};
  EXPECT_EQ(world.pipeline.refusal(hand).value_or(""), "The hand's path is longer than 30 m.");
  hand.path_W.assign(algo::kMostPathPoints + 1, hand.position_W);
  EXPECT_EQ(world.pipeline.refusal(hand).value_or(""), "The hand's path has more than 100 points.");
  hand.path_W.clear();
  hand.position_W.x() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(world.pipeline.refusal(hand).value_or(""), "The hand's goal must be finite numbers.");
  algo::RobotSpec bare = arm_spec();
  bare.arm.reset();
  const Pipeline without({}, bare);
  EXPECT_EQ(without.refusal(algo::SetJoints{}).value_or(""), "This robot has no arm.");
  EXPECT_EQ(without.refusal(algo::SetHandGoal{}).value_or(""), "This robot has no arm.");
}

TEST(ArmPipeline, JointsStopBeforeAShelfAndBeforeTheRobotItself) {
  ArmWorld world({shelf_at_the_right()});
  world.pipeline_declared = {shelf_at_the_right()};
  JointValues goal = world.q;
  goal[0] = 1.5;  // outwards
  world.tick({algo::SetJoints{goal}});
  world.run(4);
  EXPECT_EQ(world.t.limit, algo::limits::kArmNear);
  EXPECT_GT(world.room(), 0.01);
  EXPECT_LT(world.room(), 0.08);
  EXPECT_TRUE(command_rests(world.t.command));
  world.tick({algo::SetJoints{world.spec.arm->rest}});  // and back again
  world.run(4);
  EXPECT_EQ(world.t.arm.state, algo::ArmState::Arrived);

  ArmWorld alone;
  alone.tick({algo::SetJoints{}});  // all zero: the arm would hang through its base
  alone.run(4);
  EXPECT_EQ(alone.t.limit, algo::limits::kArmNear);
  EXPECT_GT(alone.t.arm.own_clearance, 0);
}

TEST(ArmPipeline, AStretchedArmStopsTheBaseUnderAStick) {
  algo::RobotSpec spec = arm_spec();
  spec.arm->rest = {0, 1.5708, 0, 0, 0, 0, 0};
  const Obstacle beam{.id = 1,
                      .pose_W = {1.6, -0.4, 0},
                      .shape = algo::Box{0.2, 1.2},
                      .height = 1.1,
                      .bottom = 0.8};
  ArmWorld world({beam}, spec);
  world.pipeline_declared = {beam};
  world.tick();
  for (int k = 0; k < 120; ++k) {
    world.tick({algo::Joystick{.forward = 1, .mode = algo::StickMode::Raw}});
  }
  EXPECT_EQ(world.t.limit, algo::limits::kArmNear);
  EXPECT_GT(world.pose.x, 0.1);
  EXPECT_GT(world.room(), 0.005);
  const double there = world.pose.x;
  for (int k = 0; k < 20; ++k) {
    world.tick({algo::Joystick{.forward = -1, .mode = algo::StickMode::Raw}});
  }
  EXPECT_LT(world.pose.x, there - 0.1);
}

TEST(ArmPipeline, TheHandGetsToItsGoalOnlyOnceItsPlanIsTaken) {
  ArmWorld world;
  algo::SetHandGoal goal;
  goal.position_W = {0.45, -0.22, 1.0};
  goal.attitude_W = {std::sqrt(0.5), 0, std::sqrt(0.5), 0};
  goal.base_stays = true;
  world.tick({goal});
  EXPECT_EQ(world.t.arm.state, algo::ArmState::Plans);
  EXPECT_EQ(world.t.mission, algo::Mission::Driving);
  EXPECT_FALSE(world.pipeline.plan_ready()) << "it takes some time";
  world.run(1);
  EXPECT_EQ(world.t.arm.state, algo::ArmState::Goes);
  EXPECT_GT(world.t.arm.plan, 0U);
  world.run(8);
  EXPECT_EQ(world.t.mission, algo::Mission::Arrived);
  const algo::MobileArm body = mobile_arm(*world.spec.arm, world.spec.radius);
  const auto frames = body_frames(body, algo::body_joints(world.pose, algo::joints_of(world.q)));
  EXPECT_LT((frames.hand() - goal.position_W).norm(), 0.01);
  EXPECT_EQ(world.pose, algo::Pose2{});

  goal.position_W = {2, 0, 1};
  world.tick({goal});
  world.run(1);
  EXPECT_EQ(world.t.mission, algo::Mission::Stuck);
  EXPECT_EQ(world.t.words.what, "No way to the goal");
  EXPECT_NE(world.t.words.why.find("m from the shoulder"), std::string::npos) << world.t.words.why;
  world.tick({algo::SetGoal{{1, 0}, {}}});
  EXPECT_FALSE(world.t.arm.hand_goal);
}

TEST(ArmPipeline, ARobotWithoutAnArmSendsNoJoints) {
  algo::RobotSpec bare = arm_spec();
  bare.arm.reset();
  Pipeline pipeline({}, bare);
  Telemetry t;
  pipeline.tick(t);
  EXPECT_EQ(t.command.joints, 0);
  EXPECT_FALSE(t.arm.present);
}

}  // namespace
