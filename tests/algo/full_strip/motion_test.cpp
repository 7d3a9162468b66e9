// tests/algo/full_strip/motion_test.cpp: clearance around hulls, roll-outs to rest, manoeuvres.
#include "algo/full_strip/motion.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "algo/full_strip/maneuver.hpp"
#include "algo/units.hpp"

namespace {

using namespace algo::units;
using algo::HullCheck;
using algo::LocalMap;
using algo::Pose2;
using algo::Vec2;

algo::RobotSpec rectangle() {
  algo::RobotSpec spec;
  spec.half_length = 0.254;
  spec.half_width = 0.215;
  spec.radius = std::hypot(spec.half_length, spec.half_width);
  return spec;
}

void occupy(LocalMap& map, const std::vector<Vec2>& points) {
  algo::LaserScan scan;
  scan.angle_increment = 0.01;
  scan.range_max = 8;
  scan.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) scan.set_ok(i, 0.01);
  for (int k = 0; k < 2; ++k) map.insert(scan, {-1000, -1000, 0}, points, {});
}

TEST(HullCheck, IsExactNearby) {
  const HullCheck hull(rectangle());
  for (const double gap : {0.02, 0.05, 0.08}) {
    LocalMap map;
    occupy(map, {{0.254 + gap, 0.1}});
    EXPECT_NEAR(hull.clearance(map, {0, 0, 0}), gap, 1e-6);
    // Turned by a quarter turn, its side is there.
    LocalMap aside;
    occupy(aside, {{0.215 + gap, 0.1}});
    EXPECT_NEAR(hull.clearance(aside, {0, 0, 90_deg}), gap, 1e-6);
  }
}

TEST(HullCheck, ADiscCoversADisc) {
  algo::RobotSpec spec;
  spec.radius = 0.35;
  LocalMap map;
  occupy(map, {{0.3, 0.3}});
  EXPECT_NEAR(HullCheck(spec).clearance(map, {0, 0, 1}), std::hypot(0.3, 0.3) - 0.35, 1e-6);
}

TEST(HullCheck, CoversOnlyCellsWellInside) {
  const HullCheck hull(rectangle());
  EXPECT_TRUE(hull.covers({1, 1, 0}, {1.1, 1.1}));
  EXPECT_FALSE(hull.covers({1, 1, 0}, {1.24, 1}));
  EXPECT_FALSE(hull.covers({1, 1, 0}, {1, 1.3}));
}

TEST(Motion, BrakesToRestWithinItsLimits) {
  const algo::MotionLimits limits{2, 2, 1, 4};
  const HullCheck hull(rectangle());
  LocalMap map;
  occupy(map, {{2.0, 0}});
  // From 1.5 m/s it needs 1.125 m and a little for the step.
  EXPECT_TRUE(rests_clear(map, hull, {{0.55, 0, 0}, {1.5, 0}}, limits, 0.05, 0.02));
  EXPECT_FALSE(rests_clear(map, hull, {{0.75, 0, 0}, {1.5, 0}}, limits, 0.05, 0.02));
}

/// A pocket 0.62 m wide, open to -x: too narrow for the hull to turn in.
std::vector<Vec2> pocket() {
  std::vector<Vec2> points;
  for (double x = -0.5; x <= 0.45; x += 0.04) {
    points.emplace_back(x, 0.31);
    points.emplace_back(x, -0.31);
  }
  for (double y = -0.31; y <= 0.31; y += 0.04) points.emplace_back(0.45, y);
  return points;
}

TEST(Maneuver, BacksOutOfAPocketAndTurns) {
  const HullCheck hull(rectangle());
  LocalMap map;
  occupy(map, pocket());
  map.seen().mark({0, 0}, 3);
  algo::ManeuverSearch search;
  search.start({0, 0, 0}, {-1.2, 0}, 0.02);
  const auto facing_out = [](const Pose2& pose) {
    return pose.x < -0.8 && std::abs(algo::wrap_angle(pose.heading - 180_deg)) < 0.3;
  };
  auto state = search.state();
  for (int k = 0; k < 2000 && state == algo::ManeuverSearch::State::Searching; ++k) {
    state = search.search(map, hull, facing_out, 50);
  }
  ASSERT_EQ(state, algo::ManeuverSearch::State::Found);
  ASSERT_FALSE(search.pieces().empty());
  EXPECT_LT(search.pieces()[0].length, 0);
  for (const algo::Piece& piece : search.pieces()) {
    EXPECT_GE(hull.clearance(map, piece.end_W), 0.02);
  }
  EXPECT_TRUE(facing_out(search.pieces().back().end_W));

  // Executed by an ideal base, the manoeuvre ends there.
  const algo::MotionLimits limits{0.5, 1, 10, 40};
  algo::ManeuverDrive drive;
  drive.start(search.pieces());
  algo::MotionState robot{{0, 0, 0}, {}};
  for (int k = 0; k < 2000; ++k) {
    const auto twist = drive.next(robot.pose_W, limits);
    if (!twist) break;
    robot = advanced(robot, *twist, limits, 0.02);
    EXPECT_GE(hull.clearance(map, robot.pose_W), 0);
  }
  EXPECT_FALSE(drive.active());
  EXPECT_LT(robot.pose_W.x, -0.7);
}

TEST(Maneuver, BacksOnlyIntoSeenSpace) {
  const HullCheck hull(rectangle());
  LocalMap map;
  occupy(map, pocket());
  hull.take_place(map.seen(), {0, 0, 0});
  algo::ManeuverSearch search;
  search.start({0, 0, 0}, {-1.2, 0}, 0.02);
  auto state = search.state();
  for (int k = 0; k < 2000 && state == algo::ManeuverSearch::State::Searching; ++k) {
    state = search.search(
        map, hull, [](const Pose2& pose) { return pose.x < -0.3; }, 50);
  }
  EXPECT_EQ(state, algo::ManeuverSearch::State::NoWay);
}

TEST(Maneuver, ReportsThatThereIsNone) {
  const HullCheck hull(rectangle());
  LocalMap map;
  std::vector<Vec2> box = pocket();
  for (double y = -0.31; y <= 0.31; y += 0.04) box.emplace_back(-0.45, y);
  occupy(map, box);
  map.seen().mark({0, 0}, 3);
  algo::ManeuverSearch search;
  search.start({0, 0, 0}, {-1.2, 0}, 0.02);
  auto state = search.state();
  for (int k = 0; k < 5000 && state == algo::ManeuverSearch::State::Searching; ++k) {
    state = search.search(
        map, hull, [](const Pose2& pose) { return pose.x < -0.8; }, 50);
  }
  EXPECT_EQ(state, algo::ManeuverSearch::State::NoWay);
}

}  // namespace
