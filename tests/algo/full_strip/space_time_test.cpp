// tests/algo/full_strip/space_time_test.cpp: giving way to moving and turning obstacles.
#include "algo/full_strip/space_time.hpp"

#include <algorithm>
#include <cmath>

#include "tests/algo/full_strip/walls.hpp"
#include <gtest/gtest.h>

namespace {

using algo::Vec2;

constexpr double kStep = 0.1;  // [s]

struct Meeting {
  algo::LocalMap map{};
  algo::RobotSpec spec{.radius = 0.3};
  algo::Recycled<algo::Track> tracks{};
  algo::MotionState robot{};
  algo::HullCheck hull{spec};
  algo::SpaceTimeSearch search{};
  algo::Weighing out{};

  algo::SpaceTimeInput input() const {
    algo::SpaceTimeInput in;
    in.map = &map;
    in.hull = &hull;
    in.spec = &spec;
    in.tracks = &tracks;
    in.state = robot;
    in.limits = {2, 2.5, 3, 8};
    return in;
  }

  /// The first command on the way to (8, 0) between a body at `at_W`, which moves with `velocity_W`
  /// along the way, and another as far on the other side.
  algo::Twist2 first(const Vec2& at_W, const Vec2& velocity_W) {
    tracks.clear();
    tracks.push_back({at_W, velocity_W, 0.25, 1, 0});
    tracks.push_back({{at_W.x(), -at_W.y()}, velocity_W, 0.25, 1, 0});
    algo::SpaceTimeInput in = input();
    in.limits = {1.2, 2, 1.5, 6};
    in.carrot_W = {8, 0};
    search.reset();
    return search.search(in, out);
  }

  /// Drives to (8, 0) past an oncoming body beside its path, which turns across it at `turn_at`
  /// [s]. Returns the least clearance between them.
  double drive(double turn_at) {
    Vec2 at_W(6, 1.3);
    Vec2 velocity_W(-1.2, 0);
    double least = 10;
    for (int k = 0; k < 45; ++k) {
      const double stamp = k * kStep;
      if (stamp >= turn_at) velocity_W = {0, -1.2};
      tracks.clear();
      tracks.push_back({at_W, velocity_W, 0.4, stamp, 0});
      algo::SpaceTimeInput in = input();
      in.stamp = stamp;
      in.carrot_W = {8, 0};
      const algo::Twist2 twist = search.search(in, out);
      robot = advanced(robot, twist, in.limits, kStep);
      at_W += kStep * velocity_W;
      least = std::min(least, (at_W - robot.pose_W.position()).norm() - 0.7);
    }
    return least;
  }
};

/// The jamb of a gap may look like a moving body. The robot must never evade a body into a standing
/// obstacle.
TEST(SpaceTime, DoesNotFleeIntoAWall) {
  for (int from = -6; from <= 6; ++from) {
    const double bearing = 0.5 * from;
    Meeting meeting;
    walls::wall(meeting.map, {-1, 0.4}, {2, 0.4});
    walls::wall(meeting.map, {-1, -0.4}, {2, -0.4});
    for (int k = 0; k < 20; ++k) {
      const Vec2 here = meeting.robot.pose_W.position();
      meeting.tracks.clear();
      meeting.tracks.push_back(
          {here + 0.7 * algo::direction(bearing), -0.5 * algo::direction(bearing), 0.24, 0.5, 0});
      algo::SpaceTimeInput in = meeting.input();
      in.stamp = k * kStep;
      in.carrot_W = {6, 0};
      const algo::Twist2 twist = meeting.search.search(in, meeting.out);
      meeting.robot = advanced(meeting.robot, twist, in.limits, kStep);
      ASSERT_GT(meeting.hull.clearance(meeting.map, meeting.robot.pose_W), 0.01)
          << "from " << bearing << " rad, step " << k;
    }
  }
}

TEST(SpaceTime, PassesAnOncomingObstacle) {
  Meeting meeting;
  EXPECT_GT(meeting.drive(100), 0.1);
  EXPECT_GT(meeting.robot.pose_W.x, 5);
}

TEST(SpaceTime, KeepsClearanceToAnObstacleThatTurnsAcross) {
  for (const double turn_at : {0.6, 1.0, 1.2, 1.4}) {
    Meeting meeting;
    EXPECT_GT(meeting.drive(turn_at), 0) << "turned after " << turn_at << " s";
  }
}

/// Somebody who walks by may turn towards the robot. It must then be able to brake.
TEST(SpaceTime, DrivesSlowerNearSomebodyWhoMayTurn) {
  Meeting near;
  near.robot.twist.v = 1.2;
  EXPECT_LT(near.first({2, 0.75}, {-1.2, 0}).v, 1.1);
  Meeting far;
  far.robot.twist.v = 1.2;
  EXPECT_GT(far.first({2, 2.5}, {-1.2, 0}).v, 1.1);
}

TEST(SpaceTime, DrivesSlowerPastSomebodyWhoStandsAndMayBeginToWalk) {
  algo::Recycled<algo::Track> standing;
  standing.push_back({.position_W = {1.0, 0.75}, .radius = 0.25});
  for (const bool known : {false, true}) {
    Meeting meeting;
    meeting.robot.twist.v = 1.2;
    algo::SpaceTimeInput in = meeting.input();
    in.limits = {1.2, 2, 1.5, 6};
    in.carrot_W = {8, 0};
    if (known) in.standing = &standing;
    const double v = meeting.search.search(in, meeting.out).v;
    EXPECT_EQ(v < 1.1, known) << v;
  }
}

/// The oncoming body's measured velocity wavers: left and right are about equally good.
TEST(SpaceTime, KeepsToItsMotionIfAnotherIsHardlyBetter) {
  constexpr double kTick = 0.05;  // [s]
  Meeting meeting;
  meeting.robot.twist.v = 1.2;
  int changes = 0;
  algo::Twist2 last{};
  for (int k = 0; k < 40; ++k) {
    const double stamp = k * kTick;
    const double wavers = k % 2 == 0 ? 0.02 : -0.02;
    meeting.tracks.clear();
    meeting.tracks.push_back({Vec2(7 - 1.2 * stamp, 0), {-1.2, wavers}, 0.25, stamp, 0});
    algo::SpaceTimeInput in = meeting.input();
    in.limits = {1.2, 2, 1.5, 6};
    in.stamp = stamp;
    in.carrot_W = {8, 0};
    const algo::Twist2 twist = meeting.search.search(in, meeting.out);
    meeting.robot = advanced(meeting.robot, twist, in.limits, kTick);
    changes += twist != last ? 1 : 0;
    last = twist;
  }
  EXPECT_LE(changes, 10);
}

/// It cannot get out of the way in time; then it must at least not drive.
TEST(SpaceTime, IsAtRestWhenATouchCannotBeAvoided) {
  Meeting meeting;
  meeting.robot.twist.v = 0.6;
  const Vec2 velocity_W(-2, 0);
  Vec2 at_W(1.7, 0);
  double stamp = 0;
  for (; (at_W - meeting.robot.pose_W.position()).norm() > 0.3 + 0.25; stamp += kStep) {
    meeting.tracks.clear();
    meeting.tracks.push_back({at_W, velocity_W, 0.25, 1, 0});
    algo::SpaceTimeInput in = meeting.input();
    in.limits = {1.2, 2, 1.5, 6};
    in.stamp = stamp;
    in.carrot_W = {8, 0};
    const algo::Twist2 twist = meeting.search.search(in, meeting.out);
    meeting.robot = advanced(meeting.robot, twist, in.limits, kStep);
    at_W += kStep * velocity_W;
    ASSERT_LT(stamp, 3);
  }
  EXPECT_LT(std::abs(meeting.robot.twist.v), 0.05);
}

}  // namespace
