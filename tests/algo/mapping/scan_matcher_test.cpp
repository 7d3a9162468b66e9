// tests/algo/mapping/scan_matcher_test.cpp: lines through points, and recovered poses.
#include "algo/mapping/scan_matcher.hpp"

#include <array>
#include <numbers>

#include "tests/algo/allocations.hpp"
#include "tests/algo/mapping/rooms.hpp"
#include <gtest/gtest.h>

#include "algo/full_strip/local_map.hpp"
#include "algo/mapping/occupancy_map.hpp"

namespace {

using algo::OccupancyMap;
using algo::Pose2;
using algo::ScanMatcher;
using algo::SurfaceFit;
using algo::Vec2;

constexpr double kReach = 20;  // [m]
const Pose2 kHere{3.0, 0.2, 0.4};

OccupancyMap map_seen_from(const Pose2& pose_W) {
  OccupancyMap map(0.05);
  map.insert(rooms::scan_at(pose_W), pose_W, kReach);
  return map;
}

double off(const Pose2& a, const Pose2& b) {
  return (a.position() - b.position()).norm();
}

TEST(SurfaceFit, IsTheLineOfLeastSquares) {
  SurfaceFit fit;
  // On y = 1 + x / 2, whose normal is (-1, 2) / sqrt(5) one way or the other.
  for (const double x : {0.0, 1.0, 2.0, 3.0}) fit.add({x, 1 + x / 2}, 1);
  const auto line = fit.line();
  ASSERT_TRUE(line);
  EXPECT_NEAR((line->on_W - Vec2(1.5, 1.75)).norm(), 0, 1e-12);
  EXPECT_NEAR(std::abs(line->normal_W.dot(Vec2(-1, 2) / std::sqrt(5.0))), 1, 1e-12);
}

TEST(SurfaceFit, AClusterOrAPairIsNoLine) {
  SurfaceFit pair;
  pair.add({0, 0}, 1);
  pair.add({1, 0}, 1);
  EXPECT_FALSE(pair.line());
  SurfaceFit square;
  for (const Vec2& p : {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(1, 1)}) square.add(p, 1);
  EXPECT_FALSE(square.line());
  SurfaceFit point;
  for (int k = 0; k < 5; ++k) point.add({2, 2}, 1);
  EXPECT_FALSE(point.line());
}

TEST(ScanMatcher, FindsAPoseThatIsOffByDecimetresAndDegrees) {
  const OccupancyMap map = map_seen_from(kHere);
  ScanMatcher matcher;
  matcher.take(rooms::scan_at(kHere), kReach);
  for (const Pose2& error : {Pose2{0.15, 0.1, 0.05}, Pose2{-0.2, 0.05, -0.06}, Pose2{}}) {
    const Pose2 guess{kHere.x + error.x, kHere.y + error.y, kHere.heading + error.heading};
    const algo::ScanMatch match = matcher.match(map, guess, {0.1, 0.1});
    EXPECT_LT(off(match.pose_W, kHere), 0.01);
    EXPECT_NEAR(match.pose_W.heading, kHere.heading, 0.003);
    EXPECT_GT(match.share, 0.8);
  }
}

TEST(ScanMatcher, SearchesWhenTheGuessIsFarOff) {
  const OccupancyMap map = map_seen_from(kHere);
  ScanMatcher matcher;
  matcher.take(rooms::scan_at(kHere), kReach);
  const Pose2 guess{kHere.x + 0.45, kHere.y - 0.4, kHere.heading + 0.2};
  const Pose2 coarse = matcher.search(map, guess);
  EXPECT_LT(off(coarse, kHere), 0.15);
  const algo::ScanMatch match = matcher.match(map, coarse, {0.1, 0.1});
  EXPECT_LT(off(match.pose_W, kHere), 0.01);
}

TEST(ScanMatcher, ReturnsTheGuessWhereTheMapIsEmpty) {
  const OccupancyMap map(0.05);
  ScanMatcher matcher;
  matcher.take(rooms::scan_at(kHere), kReach);
  const algo::ScanMatch match = matcher.match(map, kHere, {});
  EXPECT_EQ(match.pose_W, kHere);
  EXPECT_EQ(match.share, 0);
  matcher.take({}, kReach);
  EXPECT_EQ(matcher.match(map, kHere, {}).pose_W, kHere);
}

TEST(ScanMatcher, InACorridorOdometryGivesThePositionAlongIt) {
  worlds::World corridor;
  corridor.polygons = {{{-30, -1}, {30, -1}, {30, 1}, {-30, 1}}};
  algo::LaserScan scan;
  worlds::scan_world({}, corridor, 8.0, scan);  // sees neither end
  OccupancyMap map(0.05);
  map.insert(scan, {}, 7.9);
  ScanMatcher matcher;
  matcher.take(scan, 7.0);
  const algo::ScanMatch match = matcher.match(map, {0.3, 0.1, 0.05}, {});
  EXPECT_NEAR(match.pose_W.y, 0, 0.01);
  EXPECT_NEAR(match.pose_W.heading, 0, 0.005);
  EXPECT_NEAR(match.pose_W.x, 0.3, 0.05);
}

TEST(ScanMatcher, MatchesTheStripsLocalMapToo) {
  algo::LocalMap map;
  const algo::LaserScan scan = rooms::scan_at(kHere);
  std::vector<Vec2> points_W(scan.size(), Vec2(0, 0));
  for (std::size_t i = 0; i < scan.size(); ++i) {
    points_W[i] = algo::to_parent(kHere, scan.ranges[i] * algo::direction(scan.angle(i)));
  }
  for (int k = 0; k < 3; ++k) map.insert(scan, kHere, points_W, {});
  ScanMatcher matcher;
  matcher.take(scan, kReach);
  const Pose2 guess{kHere.x + 0.1, kHere.y - 0.1, kHere.heading - 0.03};
  EXPECT_LT(off(matcher.match(map, guess, {0.1, 0.1}).pose_W, kHere), 0.01);
}

TEST(ScanMatcher, RepeatsItselfAndAllocatesNothing) {
  const OccupancyMap map = map_seen_from(kHere);
  const algo::LaserScan scan = rooms::scan_at(kHere);
  ScanMatcher matcher;
  matcher.take(scan, kReach);
  const Pose2 guess{kHere.x + 0.1, kHere.y, kHere.heading + 0.02};
  const algo::ScanMatch first = matcher.match(map, guess, {});
  const std::size_t before = allocations::count();
  matcher.take(scan, kReach);
  const algo::ScanMatch second = matcher.match(map, guess, {});
  EXPECT_EQ(allocations::count(), before);
  EXPECT_EQ(second.pose_W, first.pose_W);
  EXPECT_EQ(second.share, first.share);
}

}  // namespace
