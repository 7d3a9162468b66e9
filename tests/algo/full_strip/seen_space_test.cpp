// tests/algo/full_strip/seen_space_test.cpp: which space counts as seen.
#include "algo/full_strip/seen_space.hpp"

#include <numbers>

#include "tests/algo/worlds.hpp"
#include <gtest/gtest.h>

#include "algo/full_strip/motion.hpp"

namespace {

using algo::Pose2;
using algo::SeenSpace;
using algo::Vec2;

void look(SeenSpace& seen, const worlds::World& world, const Pose2& pose) {
  algo::LaserScan scan;
  worlds::scan_world(pose, world, 8, scan);
  seen.follow(pose.position());
  for (int k = 0; k < 4; ++k) seen.look(scan, pose);
}

TEST(SeenSpace, IsTheSpaceThatBeamsPassed) {
  SeenSpace seen;
  EXPECT_FALSE(seen.seen({0.5, 0}));
  look(seen, {{{{1, 0}, 0.2}}, {}}, {0, 0, 0});
  EXPECT_TRUE(seen.seen({0.5, 0}));
  EXPECT_TRUE(seen.seen({0.82, 0}));   // the surface and what is just behind it
  EXPECT_FALSE(seen.seen({1.0, 0}));   // in the post
  EXPECT_FALSE(seen.seen({1.5, 0}));   // in its shadow
  EXPECT_FALSE(seen.seen({-0.2, 0}));  // behind the scanner
  for (double y = -1.5; y < 1.6; y += 0.1) EXPECT_TRUE(seen.seen({0.2, y})) << y;
}

TEST(SeenSpace, RollsWithTheRobot) {
  SeenSpace seen;
  const Pose2 start{0.31, -0.2, 0};
  look(seen, {}, start);
  EXPECT_TRUE(seen.seen({1.3, -0.2}));
  seen.follow({5, 3});
  EXPECT_TRUE(seen.seen({1.3, -0.2}));
  seen.follow({7.8, 3});
  EXPECT_FALSE(seen.seen({1.3, -0.2}));
  // Space that re-entered the window counts as unseen, like all that shares its cells.
  seen.follow({1, 0});
  EXPECT_FALSE(seen.seen({1.3, -0.2}));
  EXPECT_FALSE(seen.seen({1.3 + SeenSpace::kSize * SeenSpace::kCell, -0.2}));
  seen.follow({500, 0});
  EXPECT_FALSE(seen.seen({500, 0}));
}

algo::RobotSpec seen_rectangle() {
  algo::RobotSpec spec;
  spec.half_length = 0.254;
  spec.half_width = 0.215;
  spec.radius = std::hypot(spec.half_length, spec.half_width);
  return spec;
}

TEST(SeenSpace, ARoundRobotAlwaysTurnsAndBacksOnlyWhereItWas) {
  algo::RobotSpec spec;
  spec.radius = 0.35;
  const algo::HullCheck hull(spec);
  SeenSpace seen;
  hull.take_place(seen, {0, 0, 0});
  EXPECT_FALSE(hull.enters_unseen(seen, {0, 0, 0}, {0, 1}));
  EXPECT_FALSE(hull.enters_unseen(seen, {0, 0, 0}, {0.5, 1}));
  EXPECT_TRUE(hull.enters_unseen(seen, {0, 0, 0}, {-0.2, 0}));
  // After a metre it may back, but not to its start.
  look(seen, {}, {0, 0, 0});
  for (double x = 0; x < 1; x += 0.05) {
    look(seen, {}, {x, 0, 0});
    hull.stand_on(seen, {x, 0, 0});
  }
  EXPECT_FALSE(hull.enters_unseen(seen, {1, 0, 0}, {-0.2, 0}));
  EXPECT_FALSE(hull.enters_unseen(seen, {0.2, 0, 0}, {-0.2, 0.1}));
  EXPECT_TRUE(hull.enters_unseen(seen, {-0.1, 0, 0}, {-0.2, 0}));
}

TEST(SeenSpace, ARectangleTurnsAtItsStartAndThenInSeenSpace) {
  const algo::HullCheck hull(seen_rectangle());
  SeenSpace seen;
  hull.take_place(seen, {0, 0, 0});
  for (double heading = -3; heading < 3; heading += 0.1) {
    EXPECT_FALSE(hull.enters_unseen(seen, {0, 0, heading}, {0, 1})) << heading;
  }
  EXPECT_TRUE(hull.enters_unseen(seen, {-0.2, 0, 0}, {-0.3, 0}));
  EXPECT_TRUE(hull.enters_unseen(seen, {0.5, 0, 0}, {0, 1}));
}

TEST(SeenSpace, MovesWithTheRobot) {
  SeenSpace seen;
  look(seen, {{{{1, 0}, 0.2}}, {}}, {0, 0, 0});
  algo::MapMove move{.from_W = {0, 0, 0}, .to_W = {2, 1, std::numbers::pi / 2}};
  seen.move(move);
  EXPECT_TRUE(seen.seen({2, 1.5}));
  EXPECT_FALSE(seen.seen({2, 2}));    // in the post
  EXPECT_FALSE(seen.seen({2, 0.8}));  // behind the scanner
  EXPECT_FALSE(seen.seen({0.5, 0}));
}

}  // namespace
