// tests/algo/full_strip/velocity_stage_test.cpp: which commands are proven safe.
#include "algo/full_strip/velocity_stage.hpp"

#include "tests/algo/worlds.hpp"
#include <gtest/gtest.h>

namespace {

using algo::LocalMap;
using algo::Twist2;
using algo::Vec2;

/// A disc that has looked ahead of it from the origin, along x.
struct Stage {
  LocalMap map{};
  algo::NodeStrip strip{};
  algo::VelocityStage stage{};
  algo::StageInput in{};
  algo::Weighing out{};

  Stage() {
    algo::RobotSpec spec;
    spec.radius = 0.35;
    stage.set_hull(algo::HullCheck(spec));
    in.map = &map;
    in.strip = &strip;
    in.limits = {0.5, 1, 0.5, 4};
    in.dt = 0.05;
    look_from({0, 0, 0});
  }
  void look_from(const algo::Pose2& pose) {
    algo::LaserScan scan;
    worlds::scan_world(pose, {}, 8, scan);
    const std::vector<Vec2> points(scan.size(), Vec2(0, 0));
    for (int k = 0; k < 4; ++k) map.insert(scan, pose, points, {});
    stage.hull().stand_on(map.seen(), pose);
  }
};

/// The scanner does not see behind, where an obstacle may stand: this once caused collisions.
TEST(VelocityStage, DoesNotBackIntoUnseenSpace) {
  Stage s;
  EXPECT_FALSE(s.stage.back_off(s.in, s.out));
  EXPECT_FALSE(s.stage.proven(s.in, {-0.15, -1}, s.out));
  EXPECT_TRUE(s.stage.proven(s.in, {0.15, -1}, s.out));
  EXPECT_TRUE(s.stage.proven(s.in, {0, 1}, s.out));
}

TEST(VelocityStage, BacksWhereItHasLooked) {
  Stage s;
  s.look_from({0, 0, 3.0});
  s.look_from({0, 0, -1.5});
  s.look_from({0, 0, 1.5});
  EXPECT_TRUE(s.stage.back_off(s.in, s.out));
  EXPECT_EQ(s.stage.proven(s.in, {-0.15, -1}, s.out), (Twist2{-0.15, -1}));
}

/// An obstacle that the map has not seen for long may still be there.
TEST(VelocityStage, DoesNotBackIntoForgottenSpace) {
  Stage s;
  s.look_from({0, 0, 3.0});
  s.look_from({0, 0, 1.5});
  s.look_from({0, 0, -1.5});
  ASSERT_TRUE(s.stage.back_off(s.in, s.out));
  s.map.seen().forget({-0.45, 0}, 0.15);
  EXPECT_FALSE(s.stage.back_off(s.in, s.out));
}

/// A cell of the map keeps the mean of a corner's two faces, and a robot once touched the corner.
TEST(VelocityStage, DrivesNoNearerToAReturnThatIsAlmostTouched) {
  Stage s;
  ASSERT_TRUE(s.stage.proven(s.in, {0.2, 0}, s.out));
  algo::Recycled<Vec2> close_W;
  s.in.close_W = &close_W;
  close_W.push_back({0.365, 0});
  EXPECT_TRUE(s.stage.proven(s.in, {0.2, 0}, s.out)) << "one return may be an outlier";
  close_W.push_back({0.365, 0.005});
  EXPECT_FALSE(s.stage.proven(s.in, {0.2, 0}, s.out));
  EXPECT_TRUE(s.stage.proven(s.in, {0, 1}, s.out)) << "a disc that turns comes no nearer";
  close_W.clear();
  for (const double y : {0.0, 0.005}) close_W.push_back({-0.365, y});
  EXPECT_TRUE(s.stage.proven(s.in, {0.2, 0}, s.out)) << "away from it";
}

/// It once stood beside the wall for good: its strip led away from the wall by less than it turned
/// for at rest.
TEST(VelocityStage, TurnsOnTheSpotBesideAWallThatItMayNotComeNearerTo) {
  Stage s;
  algo::Recycled<Vec2> close_W;
  for (const double x : {0.0, 0.005}) close_W.push_back({x, 0.371});
  s.in.close_W = &close_W;
  algo::Recycled<Vec2> path;
  for (const Vec2& point : {Vec2(0, 0), Vec2(1, -0.1)}) path.push_back(point);
  s.strip.lay(path);
  s.in.state.pose_W.heading = 0.03;
  const auto turn = s.stage.follow(s.in, s.out);
  ASSERT_TRUE(turn);
  EXPECT_EQ(turn->v, 0);
  EXPECT_LT(turn->omega, 0);
  s.in.state.pose_W.heading = -0.06;
  const auto drive = s.stage.follow(s.in, s.out);
  ASSERT_TRUE(drive);
  EXPECT_GT(drive->v, 0);
}

/// At 40 mm/s an arc would need half a metre for this turn, and leave the strip meanwhile.
TEST(VelocityStage, ASlowRobotTurnsAlongItsStripFirst) {
  Stage s;
  algo::Recycled<Vec2> path;
  path.push_back({0, 0});
  path.push_back({1, 1});
  s.strip.lay(path);
  s.in.limits.max_v = 0.04;
  const auto slow = s.stage.follow(s.in, s.out);
  ASSERT_TRUE(slow);
  EXPECT_GT(slow->omega, 0.3);  // of a turn that has just begun
  EXPECT_GT(slow->v, 0);
}

/// Even if the strip bends away in front of a wall, the robot must be able to stop before it: a
/// strip that changed in mid-curve once caused a contact.
TEST(VelocityStage, CanAlwaysBrakeToRestAtOnce) {
  int given = 0;
  for (int cm = 5; cm < 50; cm += 2) {
    worlds::World world;
    for (int k = -40; k <= 40; ++k) {
      world.circles.push_back({{0.35 + 0.01 * cm + 0.1, 0.05 * k}, 0.1});
    }
    algo::LaserScan scan;
    worlds::scan_world({}, world, 8, scan);
    std::vector<Vec2> points(scan.size(), Vec2(0, 0));
    for (std::size_t i = 0; i < scan.size(); ++i) {
      points[i] = scan.ranges[i] * algo::direction(scan.angle(i));
    }
    Stage s;
    for (int k = 0; k < 4; ++k) s.map.insert(scan, {}, points, {});
    for (int bend = -3; bend < 12; ++bend) {
      for (int speed = 1; speed < 6; ++speed) {
        algo::Recycled<Vec2> path;
        const double x = 0.04 * bend;
        for (const Vec2& point : {Vec2(0, 0), Vec2(x, 0.1), Vec2(x, 1.5)}) path.push_back(point);
        s.strip.lay(path);
        s.in.state.twist = {0.1 * speed, 0.5};
        const auto twist = s.stage.follow(s.in, s.out);
        if (!twist) continue;
        ++given;
        const auto next = algo::advanced(s.in.state, *twist, s.in.limits, s.in.dt);
        EXPECT_TRUE(algo::rests_clear(s.map, s.stage.hull(), next, s.in.limits, s.in.dt, 0.02))
            << cm << " cm before the wall, strip " << x << ", " << speed;
      }
    }
  }
  EXPECT_GT(given, 100);
}

}  // namespace
