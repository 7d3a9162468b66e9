// tests/algo/full_strip/velocity_stage_test.cpp: which commands are proven, and which are not.
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
  algo::ControlOutput out{};

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

/// The scanner sees nothing behind, and something may stand there: what once ended in collisions.
TEST(VelocityStage, DoesNotBackIntoWhatNobodyHasSeen) {
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

/// What stood there may still: the map only has not seen it for long.
TEST(VelocityStage, DoesNotBackIntoWhatTheMapHasForgotten) {
  Stage s;
  s.look_from({0, 0, 3.0});
  s.look_from({0, 0, 1.5});
  s.look_from({0, 0, -1.5});
  ASSERT_TRUE(s.stage.back_off(s.in, s.out));
  s.map.seen().forget({-0.45, 0}, 0.15);
  EXPECT_FALSE(s.stage.back_off(s.in, s.out));
}

/// At 40 mm/s an arc would take half a metre to turn by so much, and lead past the strip meanwhile.
TEST(VelocityStage, ASlowRobotTurnsAlongItsStripFirst) {
  Stage s;
  algo::Recycled<Vec2> path;
  path.push_back({0, 0});
  path.push_back({1, 1});
  s.strip.lay(path);
  s.in.limits.max_v = 0.04;
  const auto slow = s.stage.follow(s.in, s.out);
  ASSERT_TRUE(slow);
  EXPECT_GT(slow->omega, 0.5);
  EXPECT_GT(slow->v, 0);
}

}  // namespace
