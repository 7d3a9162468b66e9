// tests/algo/full_strip/full_strip_controller_test.cpp: all layers together.
#include "algo/full_strip/full_strip_controller.hpp"

#include <cmath>
#include <numbers>

#include "tests/algo/worlds.hpp"
#include <gtest/gtest.h>

#include "algo/diff_drive.hpp"
#include "algo/driving.hpp"
#include "algo/perceive.hpp"

namespace {

using algo::Vec2;

/// A robot that follows commands exactly, among posts.
struct Drive {
  worlds::World world{};
  algo::RobotSpec spec{.radius = 0.35,
                       .half_track = 0.25,
                       .period = 0.05,
                       .max_v = 0.5,
                       .max_omega = 1.0,
                       .max_acceleration = 0.5,
                       .max_angular_acceleration = 4,
                       .drives = true};
  algo::Parameters parameters{};
  algo::Pose2 pose{};
  algo::Twist2 twist{};
  double stamp = 0;
  algo::Scene scene{};
  algo::Observation observation{};
  algo::FullStripController controller{};
  algo::ControlOutput out{};
  bool interrupted = false;  // another behaviour keeps the robot where it is

  void tick(const Vec2& goal) {
    worlds::scan_world(pose, world, 8, scene.scan);
    scene.scan.stamp = stamp;
    scene.fresh = true;
    algo::perceive(pose, scene);
    algo::ControlInput in;
    in.stamp = stamp;
    in.dt = spec.period;
    in.odometry = {stamp, pose, twist};
    in.scene = &scene;
    in.observation = &observation;
    in.spec = &spec;
    in.goal = algo::SetGoal{goal, std::nullopt};
    in.interrupted = interrupted;
    controller.update(in, parameters, out);
    if (interrupted) {
      twist = {};
      stamp += spec.period;
      return;
    }
    const double dv = spec.max_acceleration * spec.period;
    const double dw = spec.max_angular_acceleration * spec.period;
    twist = {twist.v + std::clamp(out.twist.v - twist.v, -dv, dv),
             twist.omega + std::clamp(out.twist.omega - twist.omega, -dw, dw)};
    pose = algo::integrate_arc(pose, twist, spec.period);
    stamp += spec.period;
  }
};

TEST(FullStrip, ASlowRobotIsNotReportedStuck) {
  Drive drive;
  drive.parameters.set(algo::kMaxSpeed, 0.04);
  drive.controller.reset({});
  for (int k = 0; k < 1000; ++k) {
    drive.tick({3, 0});
    EXPECT_EQ(drive.out.state, algo::FullStripController::kFollowing) << "tick " << k;
    EXPECT_LE(std::abs(drive.out.twist.v), 0.04 + 1e-12);
  }
  EXPECT_GT(drive.pose.x, 1.9);
}

TEST(FullStrip, TakesNoInterruptionForABlockage) {
  Drive drive;
  drive.controller.reset({});
  for (int k = 0; k < 40; ++k) drive.tick({6, 0});
  drive.interrupted = true;
  for (int k = 0; k < 200; ++k) {  // 10 s without a step of its own
    drive.tick({6, 0});
    EXPECT_EQ(drive.out.state, algo::FullStripController::kFollowing) << "tick " << k;
  }
  drive.interrupted = false;
  for (int k = 0; k < 40; ++k) drive.tick({6, 0});
  EXPECT_EQ(drive.out.state, algo::FullStripController::kFollowing);
  EXPECT_GT(drive.pose.x, 1.0);
}

TEST(FullStrip, StaysWithinItsLimitsEvenWhenEnclosed) {
  Drive drive;
  drive.parameters.set(algo::kMaxSpeed, 0.05);
  drive.parameters.set(algo::kMaxTurnRate, 0.3);
  for (int i = 0; i < 16; ++i) {
    const double bearing = 2 * 3.14159265 * i / 16;
    drive.world.circles.push_back({0.62 * algo::direction(bearing), 0.12});
  }
  drive.controller.reset({});
  for (int k = 0; k < 600; ++k) {
    drive.tick({4, 0});
    EXPECT_LE(std::abs(drive.out.twist.v), 0.05 + 1e-12);
    EXPECT_LE(std::abs(drive.out.twist.omega), 0.3 + 1e-12);
  }
  EXPECT_LT(drive.pose.position().norm(), 0.3);  // there is no way out, and it reports that
  EXPECT_NE(drive.out.state, algo::FullStripController::kFollowing);
}

TEST(FullStrip, ReachesAGoalFarBeyondItsMap) {
  Drive drive;
  drive.parameters.set(algo::kMaxSpeed, 0.5);
  drive.world.circles.push_back({{15, 0.1}, 0.3});
  drive.controller.reset({});
  for (int k = 0; k < 2400 && drive.pose.x < 39; ++k) drive.tick({40, 0});
  EXPECT_GT(drive.pose.x, 39);
  EXPECT_EQ(drive.out.state, algo::FullStripController::kFollowing);
}

/// The outer half metre of the map is no goal: a strip to there once ended beside a goal just
/// beyond the map and was never replanned.
TEST(FullStrip, ReachesAGoalAtTheEdgeOfItsMap) {
  for (const double far : {12.2, 12.4, 12.5, 12.6, 12.7, 12.8, 13.0}) {
    Drive drive;
    drive.parameters.set(algo::kMaxSpeed, 0.5);
    drive.controller.reset({});
    const Vec2 goal(far, 0);
    for (int k = 0; k < 900 && (drive.pose.position() - goal).norm() > 0.09; ++k) drive.tick(goal);
    EXPECT_LT((drive.pose.position() - goal).norm(), 0.1) << far;
  }
}

TEST(FullStrip, AGoalInAnObstacleIsRefusedOrApproachedAsConfigured) {
  for (const double near : {1.0, 0.0}) {
    Drive drive;
    drive.parameters.set(algo::kNearestGoal, near);
    drive.world.circles = {{{4, 0.05}, 0.4}};
    drive.controller.reset({});
    for (int k = 0; k < 600; ++k) drive.tick({4, 0});
    EXPECT_EQ(drive.out.state, algo::FullStripController::kGoalTaken);
    EXPECT_EQ(drive.out.twist, algo::Twist2{});
    const double from_it = (drive.pose.position() - Vec2(4, 0.05)).norm() - 0.75;
    EXPECT_GT(from_it, 0.02);
    if (near == 1.0) {
      EXPECT_LT(from_it, 0.3);
    } else {
      EXPECT_GT(from_it, 0.5);
    }
  }
}

/// A clearance of 2 to 6 cm is less than wanted, but enough.
TEST(FullStrip, ReachesAGoalWithLessThanTheWantedClearance) {
  for (const double room : {0.02, 0.04, 0.06}) {
    Drive drive;
    drive.world.circles = {{{3, 0.35 + room + 0.4}, 0.4}};
    drive.controller.reset({});
    for (int k = 0; k < 600; ++k) drive.tick({3, 0});
    EXPECT_LT((drive.pose.position() - Vec2(3, 0)).norm(), 0.1) << "room " << room;
  }
}

/// It keeps the refusal instead of trying again and again.
TEST(FullStrip, AGoalWithoutClearanceStaysRefused) {
  Drive drive;
  drive.world.circles = {{{3, 0.6}, 0.4}};
  drive.controller.reset({});
  int others = 0;
  for (int k = 0; k < 1200; ++k) {
    drive.tick({3, 0});
    if (k >= 800 && drive.out.state != algo::FullStripController::kGoalTaken) ++others;
  }
  EXPECT_EQ(others, 0);
  EXPECT_LT((drive.pose.position() - Vec2(3, 0)).norm(), 0.3);
}

/// If the goal is nearer to a post than the strip's clearance, the strip keeps the goal's
/// clearance.
TEST(FullStrip, GoesNoNearerToAPostThanItsGoal) {
  Drive drive;
  drive.parameters.set(algo::kSafetyDistance, 1.0);
  drive.parameters.set(algo::kMaxSpeed, 0.2);
  drive.world.circles = {{{1.2, 0.35}, 0.1}};
  const Vec2 goal(2, 0);
  const double lies = worlds::surface_distance(goal, drive.world);
  drive.controller.reset({});
  double least = 10;
  for (int k = 0; k < 600 && (drive.pose.position() - goal).norm() > 0.1; ++k) {
    drive.tick(goal);
    least = std::min(least, worlds::surface_distance(drive.pose.position(), drive.world));
  }
  EXPECT_LT((drive.pose.position() - goal).norm(), 0.1);
  EXPECT_GT(least, lies - 0.02);
  EXPECT_LT(least, lies + 0.1);
}

/// In a niche, with the goal behind it and an unseen post close behind it: it must not back into
/// the post. Being round, it may turn on the spot and look.
TEST(FullStrip, DoesNotBackIntoUnseenSpace) {
  for (const double gap : {0.05, 0.12}) {
    for (const double aside : {0.0, 0.2}) {
      Drive drive;
      for (const double x : {0.48, 0.30, 0.12}) {
        drive.world.circles.push_back({{x, 0.47}, 0.06});
        drive.world.circles.push_back({{x, -0.47}, 0.06});
      }
      drive.world.circles.push_back({{0.48, 0}, 0.06});
      const Vec2 behind = algo::direction(std::numbers::pi + aside);
      drive.world.circles.push_back({(0.35 + gap + 0.2) * behind, 0.2});
      drive.controller.reset({});
      for (int k = 0; k < 600; ++k) {
        drive.tick({-4, 0.5});
        ASSERT_GT(worlds::surface_distance(drive.pose.position(), drive.world), 0.35)
            << "gap " << gap << ", aside " << aside << ", tick " << k;
      }
    }
  }
}

/// As above, but with free space behind it: it turns round or backs out.
TEST(FullStrip, GetsOutOfANicheItStartsIn) {
  Drive drive;
  for (const double x : {0.48, 0.30, 0.12}) {
    drive.world.circles.push_back({{x, 0.47}, 0.06});
    drive.world.circles.push_back({{x, -0.47}, 0.06});
  }
  drive.world.circles.push_back({{0.48, 0}, 0.06});
  drive.controller.reset({});
  for (int k = 0; k < 800; ++k) drive.tick({-4, 0.5});
  EXPECT_LT((drive.pose.position() - Vec2(-4, 0.5)).norm(), 0.2);
}

/// A long robot with an obstacle close ahead must back before it can turn. It once abandoned the
/// escape after each tick and did not move.
TEST(FullStrip, CompletesAnEscape) {
  Drive drive;
  drive.spec.half_length = 0.35;
  drive.spec.half_width = 0.22;
  drive.spec.radius = std::hypot(0.35, 0.22);
  drive.parameters.set(algo::kMaxSpeed, 0.4);
  drive.controller.reset({});
  for (int k = 0; k < 100; ++k) drive.tick({1.5, 0});
  ASSERT_EQ(drive.twist, algo::Twist2{});
  const double nose = drive.pose.x + 0.35;
  drive.world.circles = {{{nose + 0.045, 0.2}, 0.02}, {{nose + 0.045, -0.2}, 0.02}};
  drive.world.circles.push_back({{nose + 0.045, 0}, 0.02});
  double run = 0;
  double longest = 0;
  for (int k = 0; k < 200; ++k) {
    drive.tick({4, 0});
    run = drive.out.state == algo::FullStripController::kEscaping ? run + drive.spec.period : 0;
    longest = std::max(longest, run);
  }
  EXPECT_GE(longest, 0.5);
  for (int k = 0; k < 400; ++k) drive.tick({4, 0});
  EXPECT_LT((drive.pose.position() - Vec2(4, 0)).norm(), 0.2);
}

/// Between standing obstacles the strip must settle instead of oscillating, and so must the robot.
TEST(FullStrip, DoesNotSway) {
  Drive drive;
  drive.parameters.set(algo::kMaxSpeed, 0.5);
  drive.parameters.set(algo::kSafetyDistance, 0.75);
  for (int i = 0; i < 6; ++i) {
    const double side = i % 2 == 0 ? 1 : -1;
    drive.world.circles.push_back({{1.5 + 1.4 * i, 0.75 * side}, 0.2});
  }
  drive.controller.reset({});
  int changes = 0;
  double before = 0;
  const Vec2 goal(10, 0);
  for (int k = 0; k < 800 && (drive.pose.position() - goal).norm() > 0.1; ++k) {
    drive.tick(goal);
    const double turn = drive.out.twist.omega;
    if (std::abs(turn) < 0.02) continue;  // straight
    if (turn * before < 0) ++changes;
    before = turn;
  }
  EXPECT_LT((drive.pose.position() - goal).norm(), 0.12);
  EXPECT_LT(changes / drive.stamp, 1);
}

TEST(FullStrip, PassesAPostOnItsLine) {
  Drive drive;
  drive.world.circles = {{{2, 0.02}, 0.3}};
  drive.controller.reset({});
  double nearest = 1e9;
  for (int k = 0; k < 800; ++k) {
    drive.tick({4, 0});
    nearest = std::min(nearest, (drive.pose.position() - Vec2(2, 0.02)).norm() - 0.65);
  }
  EXPECT_LT((drive.pose.position() - Vec2(4, 0)).norm(), 0.12);
  EXPECT_GT(nearest, 0.02);
}

/// The loop that the robot has closed moves it and its map 0.6 m aside. Where its own map shows a
/// wall across the way, there is none.
TEST(FullStrip, DrivesOnByTheMapAfterAMove) {
  Drive drive;
  drive.world.circles = {{{3, 1}, 0.1}, {{3, -1}, 0.1}};
  const Vec2 goal(6, 0);
  for (int k = 0; k < 60; ++k) drive.tick(goal);
  ASSERT_GT(drive.pose.x, 0.5);
  algo::MapMove move{.from_W = drive.pose};
  drive.pose.y += 0.6;
  for (worlds::Circle& post : drive.world.circles) post.centre.y() += 0.6;
  move.to_W = drive.pose;
  move.stations = {{{0, 0, 0}, {0, 0.6, 0}}};
  for (const worlds::Circle& post : drive.world.circles) {
    move.walls_W.emplace_back(post.centre.cast<float>() - Eigen::Vector2f(0.1F, 0));
  }
  drive.controller.move(move, drive.pose);
  drive.tick(goal);
  const algo::LocalMap& map = drive.controller.senses().map();
  EXPECT_LT(map.distance({2.9, 1.6}), 0.1);
  EXPECT_GT(map.distance({2.9, 1}), 0.4) << "it lies there no more";
  const auto driven = [&](double y) {
    return drive.controller.senses().memory().driven(algo::BuildingMemory::cell_of({0.3, y}));
  };
  EXPECT_TRUE(driven(0.5) || driven(0.7));
  EXPECT_FALSE(driven(-0.1) || driven(0.1));
  for (int k = 0; k < 400 && (drive.pose.position() - goal).norm() > 0.2; ++k) drive.tick(goal);
  EXPECT_LT((drive.pose.position() - goal).norm(), 0.2);
}

TEST(FullStrip, ForgetsAllInAMoveBeforeItsFirstTick) {
  algo::FullStripController controller;
  algo::MapMove move;
  move.stations.emplace_back();
  move.walls_W.emplace_back(1.0F, 0.0F);
  controller.move(move, {});
  EXPECT_EQ(controller.senses().map().distance({1, 0}), algo::LocalMap::kReach);
}

}  // namespace
