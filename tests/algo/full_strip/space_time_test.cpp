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

}  // namespace
