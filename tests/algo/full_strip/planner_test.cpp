// tests/algo/full_strip/planner_test.cpp: paths, missing paths, replaced goals, and bounded work.
#include "algo/full_strip/planner.hpp"

#include <cmath>

#include "tests/algo/full_strip/walls.hpp"
#include <gtest/gtest.h>

#include "algo/full_strip/node_strip.hpp"

namespace {

using algo::LocalMap;
using algo::Planner;
using algo::Vec2;
using walls::wall;

Planner::State finish(Planner& planner, const LocalMap& map) {
  Planner::State state = planner.state();
  for (int k = 0; k < 10'000 && state == Planner::State::Searching; ++k) {
    state = planner.search(map, 50);
  }
  return state;
}

double length(const algo::Recycled<Vec2>& path) {
  double sum = 0;
  for (std::size_t i = 1; i < path.size(); ++i) sum += (path[i] - path[i - 1]).norm();
  return sum;
}

TEST(Planner, GoesStraightWhereNothingStands) {
  LocalMap map;
  Planner planner;
  planner.start(map, {0, 0}, {5, 0}, 0.3, true);
  ASSERT_EQ(finish(planner, map), Planner::State::Found);
  algo::Recycled<Vec2> path;
  planner.path(path);
  EXPECT_NEAR(length(path), 5, 0.15);
  EXPECT_FALSE(planner.goal_taken());
}

TEST(Planner, TakesTheGapAndKeepsItsClearance) {
  LocalMap map;
  wall(map, {2, -4}, {2, 1.0});
  wall(map, {2, 2.0}, {2, 4});
  Planner planner;
  planner.start(map, {0, 0}, {4, 0}, 0.3, true);
  ASSERT_EQ(finish(planner, map), Planner::State::Found);
  algo::Recycled<Vec2> path;
  planner.path(path);
  for (const Vec2& p : path) EXPECT_GE(map.distance(p), 0.28);
}

TEST(Planner, ReportsThatThereIsNoPath) {
  LocalMap map;
  for (const double y : {-1.5, 1.5}) wall(map, {2.5, y}, {5.5, y});
  for (const double x : {2.5, 5.5}) wall(map, {x, -1.5}, {x, 1.5});
  Planner planner;
  planner.start(map, {0, 0}, {4, 0}, 0.3, true);
  EXPECT_EQ(finish(planner, map), Planner::State::NoWay);
}

TEST(Planner, AGoalInAnObstacleIsReplacedByThePlaceBesideIt) {
  LocalMap map;
  wall(map, {4, -0.1}, {4, 0.1});
  Planner planner;
  planner.start(map, {0, 0}, {4, 0}, 0.3, true);
  ASSERT_EQ(finish(planner, map), Planner::State::Found);
  EXPECT_TRUE(planner.goal_taken());
}

TEST(Planner, AReplacedGoalLiesInSeenSpace) {
  LocalMap map;
  wall(map, {4, -0.5}, {4, 0.5});
  map.seen().follow({0, 0});
  map.seen().mark({3.2, 0}, 0.6);
  Planner planner;
  planner.start(map, {0, 0}, {4.05, 0}, 0.3, true);  // nearer to the wall's back
  ASSERT_EQ(finish(planner, map), Planner::State::Found);
  EXPECT_TRUE(planner.goal_taken());
  algo::Recycled<Vec2> path;
  planner.path(path);
  EXPECT_LT(path.back().x(), 4);
}

TEST(Planner, ANearGoalIsTriedWithoutClearanceIfConfigured) {
  LocalMap map;
  wall(map, {0.5, -0.1}, {0.5, 0.1});
  Planner planner;
  for (const bool try_tight : {true, false}) {
    planner.start(map, {0, 0}, {0.25, 0}, 0.3, try_tight);
    EXPECT_EQ(planner.goal_tight(), try_tight);
    EXPECT_EQ(planner.goal_taken(), !try_tight);
  }
}

TEST(Planner, AGoalBeyondTheMapIsReplacedOnItsBorder) {
  LocalMap map;
  Planner planner;
  planner.start(map, {0, 0}, {400, 0}, 0.3, true);
  ASSERT_EQ(finish(planner, map), Planner::State::Found);
  EXPECT_FALSE(planner.goal_taken());
  algo::Recycled<Vec2> path;
  planner.path(path);
  EXPECT_LT(path.back().x(), 20);
}

TEST(Planner, StaysWithinItsBudget) {
  LocalMap map;
  Planner planner;
  planner.start(map, {-5, -5}, {5, 4}, 0.3, true);
  EXPECT_EQ(planner.search(map, 10), Planner::State::Searching);
  EXPECT_EQ(finish(planner, map), Planner::State::Found);
}

algo::Recycled<Vec2> path_of(std::initializer_list<Vec2> points) {
  algo::Recycled<Vec2> path;
  for (const Vec2& point : points) path.push_back(point);
  return path;
}

TEST(Straighten, LeavesNoLatticeCornerInFreeSpace) {
  const LocalMap map;
  algo::Recycled<Vec2> path = path_of({{0, 0}, {1, 1}, {2, 2}, {3, 2}, {4, 2}});
  algo::straighten(map, 0.75, path);
  ASSERT_EQ(path.size(), 2u);
  EXPECT_EQ(path[0], Vec2(0, 0));
  EXPECT_EQ(path[1], Vec2(4, 2));
}

/// Around the end of a wall, the smoothed line may come no nearer than the path itself.
TEST(Straighten, KeepsItsClearanceToStandingObstacles) {
  LocalMap map;
  wall(map, {2, -3}, {2, 0});
  algo::Recycled<Vec2> path =
      path_of({{0, 0}, {0.5, 0.5}, {1, 1}, {2, 1}, {3, 1}, {3.5, 0.5}, {4, 0}});
  algo::straighten(map, 0.75, path);
  EXPECT_LT(path.size(), 7u);
  for (std::size_t i = 1; i < path.size(); ++i) {
    for (int k = 0; k <= 20; ++k) {
      EXPECT_GT(map.distance(path[i - 1] + 0.05 * k * (path[i] - path[i - 1])), 0.7);
    }
  }
}

/// With less clearance than that, the path stays as found.
TEST(Straighten, TouchesNothingInANarrowPassage) {
  LocalMap map;
  wall(map, {-1, 0.6}, {6, 0.6});
  wall(map, {-1, -0.6}, {6, -0.6});
  algo::Recycled<Vec2> path = path_of({{0, 0}, {1, 0.1}, {2, 0}});
  algo::straighten(map, 0.75, path);
  EXPECT_EQ(path.size(), 3u);
}

TEST(NodeStrip, RelaxesToTheMiddleOfACorridor) {
  LocalMap map;
  wall(map, {-1, 0.6}, {6, 0.6});
  wall(map, {-1, -0.6}, {6, -0.6});
  algo::Recycled<Vec2> path;
  path.push_back({0, 0});
  path.push_back({1, 0.25});
  path.push_back({4, 0.25});
  path.push_back({5, 0});
  algo::NodeStrip strip;
  strip.lay(path);
  const algo::StripSettings settings{.least_clearance = 0.25};
  strip.relax(map, settings, 60);
  for (const algo::Node& node : strip.nodes()) EXPECT_NEAR(node.position_W.y(), 0, 0.06);
  EXPECT_LT(strip.broken_at(map, settings), 0);
}

TEST(NodeStrip, FollowCutsThePartBehindTheRobot) {
  algo::Recycled<Vec2> path;
  path.push_back({0, 0});
  path.push_back({3, 0});
  algo::NodeStrip strip;
  strip.lay(path);
  strip.follow({1, 0.1});
  EXPECT_EQ(strip.nodes()[0].position_W, Vec2(1, 0.1));
  EXPECT_NEAR(strip.length(), 2, 0.1);
  EXPECT_EQ(strip.end_W(), Vec2(3, 0));
}

TEST(NodeStrip, IsBrokenByANewObstacle) {
  LocalMap map;
  algo::Recycled<Vec2> path;
  path.push_back({0, 0});
  path.push_back({3, 0});
  algo::NodeStrip strip;
  strip.lay(path);
  wall(map, {1.5, -0.3}, {1.5, 0.3});
  EXPECT_NEAR(strip.broken_at(map, {.least_clearance = 0.2}), 1.35, 0.16);
}

}  // namespace
