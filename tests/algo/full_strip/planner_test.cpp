// tests/algo/full_strip/planner_test.cpp: paths, missing paths, replaced goals, and bounded work.
#include "algo/full_strip/planner.hpp"

#include <cmath>

#include "tests/algo/full_strip/walls.hpp"
#include <gtest/gtest.h>

#include "algo/full_strip/node_strip.hpp"

namespace {

using algo::BuildingMemory;
using algo::LocalMap;
using algo::Planner;
using algo::Vec2;
using walls::wall;

constexpr algo::StepCost kStepCost{.half_width = 0.28, .least = 0.3};

/// A map, what is remembered beyond it, and a search over both.
struct Search {
  LocalMap map{};
  BuildingMemory memory{};
  Planner planner{};
  Planner::Path path{};

  algo::PlanWorld world() const { return {map, memory}; }
  void start(const Vec2& from_W, const Vec2& to_W, bool try_tight = true, bool exact = false) {
    planner.start(
        world(), from_W, to_W, {.cost = kStepCost, .exact = exact, .try_tight = try_tight});
  }
  Planner::State finish() {
    Planner::State state = planner.state();
    for (int k = 0; k < 20'000 && state == Planner::State::Searching; ++k) {
      state = planner.search(world(), 50);
    }
    planner.path(world(), path);
    return state;
  }
  /// A beam has come to each coarse cell of the rectangle from nearby.
  void look_at(const Vec2& low_W, const Vec2& high_W) {
    for (double y = low_W.y(); y <= high_W.y(); y += 0.1) {
      for (double x = low_W.x(); x <= high_W.x(); x += 0.1) {
        const BuildingMemory::Cell cell = BuildingMemory::cell_of({x, y});
        memory.get(BuildingMemory::tile_of(cell.column), BuildingMemory::tile_of(cell.row)).near |=
            std::uint64_t{1} << BuildingMemory::within(cell);
      }
    }
  }
  /// Remembers that the coarse cells of the rectangle are `cm` from the nearest thing.
  void remember(const Vec2& low_W, const Vec2& high_W, std::uint8_t cm) {
    const BuildingMemory::Cell low = BuildingMemory::cell_of(low_W);
    const BuildingMemory::Cell high = BuildingMemory::cell_of(high_W);
    for (int row = low.row; row <= high.row; ++row) {
      for (int column = low.column; column <= high.column; ++column) {
        BuildingMemory::Tile& tile =
            memory.get(BuildingMemory::tile_of(column), BuildingMemory::tile_of(row));
        tile.clearance[BuildingMemory::within({column, row})] = cm;
        tile.seen[BuildingMemory::within({column, row})] = 1;
      }
    }
  }
};

double length(const algo::Recycled<Vec2>& path) {
  double sum = 0;
  for (std::size_t i = 1; i < path.size(); ++i) sum += (path[i] - path[i - 1]).norm();
  return sum;
}

TEST(Planner, GoesStraightWhereNothingStands) {
  Search search;
  search.start({0, 0}, {5, 0});
  ASSERT_EQ(search.finish(), Planner::State::Found);
  EXPECT_NEAR(length(search.path.points_W), 5, 0.15);
  EXPECT_FALSE(search.planner.goal_taken());
}

TEST(Planner, TakesTheGapAndKeepsItsClearance) {
  Search search;
  wall(search.map, {2, -4}, {2, 1.0});
  wall(search.map, {2, 2.0}, {2, 4});
  search.start({0, 0}, {4, 0});
  ASSERT_EQ(search.finish(), Planner::State::Found);
  for (const Vec2& p : search.path.points_W) EXPECT_GE(search.map.distance(p), 0.28);
}

TEST(Planner, ReportsThatThereIsNoPath) {
  Search search;
  for (const double y : {-1.5, 1.5}) wall(search.map, {2.5, y}, {5.5, y});
  for (const double x : {2.5, 5.5}) wall(search.map, {x, -1.5}, {x, 1.5});
  search.start({0, 0}, {4, 0});
  EXPECT_EQ(search.finish(), Planner::State::NoWay);
}

TEST(Planner, AGoalInAnObstacleIsReplacedByThePlaceBesideIt) {
  Search search;
  wall(search.map, {4, -0.1}, {4, 0.1});
  search.start({0, 0}, {4, 0});
  ASSERT_EQ(search.finish(), Planner::State::Found);
  EXPECT_TRUE(search.planner.goal_taken());
}

TEST(Planner, AReplacedGoalLiesInSeenSpace) {
  Search search;
  wall(search.map, {4, -0.5}, {4, 0.5});
  search.remember({2.6, -0.6}, {3.8, 0.6}, BuildingMemory::kUnknown);
  search.start({0, 0}, {4.05, 0});  // nearer to the wall's back
  ASSERT_EQ(search.finish(), Planner::State::Found);
  EXPECT_TRUE(search.planner.goal_taken());
  EXPECT_LT(search.path.points_W.back().x(), 4);
}

TEST(Planner, ANearGoalIsTriedWithoutClearanceIfConfigured) {
  Search search;
  wall(search.map, {0.5, -0.1}, {0.5, 0.1});
  for (const bool try_tight : {true, false}) {
    search.start({0, 0}, {0.25, 0}, try_tight);
    EXPECT_EQ(search.planner.goal_tight(), try_tight);
    EXPECT_EQ(search.planner.goal_taken(), !try_tight);
  }
}

TEST(Planner, AGoalTooFarAwayIsReplacedOnTheWayToIt) {
  Search search;
  search.start({0, 0}, {400, 0});
  ASSERT_EQ(search.finish(), Planner::State::Found);
  EXPECT_FALSE(search.planner.goal_taken());
  EXPECT_NEAR(search.path.points_W.back().x(), Planner::kFarthest, 1);
  const Vec2 last_W = search.path.points_W[search.path.local - 1];
  EXPECT_NEAR(last_W.x(), 11.2, 0.5);  // the map's inner tiles end there
  EXPECT_GT(search.path.beyond, 70);
}

TEST(Planner, StaysWithinItsBudget) {
  Search search;
  search.start({-5, -5}, {5, 4});
  EXPECT_EQ(search.planner.search(search.world(), 10), Planner::State::Searching);
  EXPECT_EQ(search.finish(), Planner::State::Found);
}

/// Between the robot and a goal far beyond the map, a wall is remembered.
TEST(Planner, GoesRoundWhatIsRememberedBeyondTheMap) {
  Search search;
  search.remember({20, -8}, {20.1, 8}, 0);
  search.start({0, 0}, {30, 0});
  ASSERT_EQ(search.finish(), Planner::State::Found);
  EXPECT_GT(length(search.path.points_W), 32);
  for (const Vec2& p : search.path.points_W) {
    EXPECT_NE(search.memory.clearance(BuildingMemory::cell_of(p)), 0);
  }
}

TEST(Planner, ReportsThatARememberedRoomHasNoDoor) {
  Search search;
  for (const double y : {-3.0, 3.0}) search.remember({25, y}, {31, y + 0.1}, 0);
  for (const double x : {25.0, 31.0}) search.remember({x, -3}, {x + 0.1, 3.1}, 0);
  search.start({0, 0}, {28, 0});
  EXPECT_EQ(search.finish(), Planner::State::NoWay);
}

/// From the robot in a shut room: the search comes to the wall before the goal.
TEST(Planner, TellsThePlaceWithinReachThatIsNearestToTheGoal) {
  Search search;
  for (const double y : {-2.0, 2.0}) wall(search.map, {-2, y}, {2, y});
  for (const double x : {-2.0, 2.0}) wall(search.map, {x, -2}, {x, 2});
  search.start({6, 0.5}, {0, 0});
  ASSERT_EQ(search.finish(), Planner::State::NoWay);
  EXPECT_NEAR(search.planner.closest_W().x(), 1.65, 0.15);
  EXPECT_NEAR(search.planner.closest_W().y(), 0.5, 0.3);
}

TEST(Planner, PrefersSeenSpaceToUnseenSpace) {
  Search search;
  search.memory.get(0, 0);
  wall(search.map, {4, -1}, {4, 1});
  search.remember({-1, 0.2}, {9, 3}, BuildingMemory::kUnknown);
  search.start({0, 0}, {8, 0});
  ASSERT_EQ(search.finish(), Planner::State::Found);
  for (const Vec2& p : search.path.points_W) EXPECT_GT(p.y(), -0.3);
}

/// The lattice alone sees less room in a door than there is.
TEST(Planner, PassesADoorThatHasJustRoomEnough) {
  int passed = 0;
  for (int k = 0; k < 10; ++k) {
    const double off = 0.01 * k;
    Search search;
    wall(search.map, {2, -4}, {2, off - 0.32});
    wall(search.map, {2, off + 0.32}, {2, 4});
    search.start({0, 0}, {4, 0}, true, true);
    if (search.finish() == Planner::State::Found && length(search.path.points_W) < 5) ++passed;
  }
  EXPECT_EQ(passed, 10);
}

TEST(Planner, KnowsTheCostFromPlacesItHasSearched) {
  Search search;
  search.start({0, 0}, {5, 0});
  ASSERT_EQ(search.finish(), Planner::State::Found);
  EXPECT_EQ(search.planner.cost_from({5, 0}), 0);
  ASSERT_TRUE(search.planner.cost_from({0, 0}));
  EXPECT_NEAR(*search.planner.cost_from({0, 0}), 5 * algo::StepCost::kUnseen, 0.5);
  EXPECT_FALSE(search.planner.cost_from({-8, 0}));
}

algo::Recycled<Vec2> path_of(std::initializer_list<Vec2> points) {
  algo::Recycled<Vec2> path;
  for (const Vec2& point : points) path.push_back(point);
  return path;
}

TEST(Straighten, LeavesNoLatticeCornerInFreeSpace) {
  const LocalMap map;
  const BuildingMemory memory;
  algo::Recycled<Vec2> path = path_of({{0, 0}, {1, 1}, {2, 2}, {3, 2}, {4, 2}});
  algo::straighten({map, memory}, 0.75, 0.3, path);
  ASSERT_EQ(path.size(), 2u);
  EXPECT_EQ(path[0], Vec2(0, 0));
  EXPECT_EQ(path[1], Vec2(4, 2));
}

/// Around the end of a wall, the smoothed line may come no nearer than the path itself.
TEST(Straighten, KeepsItsClearanceToStandingObstacles) {
  LocalMap map;
  const BuildingMemory memory;
  wall(map, {2, -3}, {2, 0});
  algo::Recycled<Vec2> path =
      path_of({{0, 0}, {0.5, 0.5}, {1, 1}, {2, 1}, {3, 1}, {3.5, 0.5}, {4, 0}});
  algo::straighten({map, memory}, 0.75, 0.3, path);
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
  const BuildingMemory memory;
  wall(map, {-1, 0.6}, {6, 0.6});
  wall(map, {-1, -0.6}, {6, -0.6});
  algo::Recycled<Vec2> path = path_of({{0, 0}, {1, 0.1}, {2, 0}});
  algo::straighten({map, memory}, 0.75, 0.3, path);
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

/// A goal in a pen with a gap of 0.5 m, too narrow for the hull: from afar, a door seen at a flat
/// angle looks the same.
struct Pen : Search {
  Pen() {
    wall(map, {3, -1}, {3, -0.25});
    wall(map, {3, 0.25}, {3, 1});
    wall(map, {3, 1}, {5, 1});
    wall(map, {5, 1}, {5, -1});
    wall(map, {5, -1}, {3, -1});
  }
  Planner::State search_for_it(bool lenient) {
    planner.start(world(), {0, 0}, {4, 0}, {.cost = kStepCost, .exact = true, .lenient = lenient});
    return finish();
  }
};

TEST(Planner, ALenientSearchLeadsToANarrowPlaceThatNobodyHasSeenFromNearby) {
  Pen pen;
  EXPECT_EQ(pen.search_for_it(false), Planner::State::NoWay);
  ASSERT_EQ(pen.search_for_it(true), Planner::State::Found);
  EXPECT_TRUE(pen.path.unsure);
  pen.look_at({2.5, -0.5}, {3.5, 0.5});
  EXPECT_EQ(pen.search_for_it(true), Planner::State::NoWay);
}

/// The scans of a jamb err by more than the room that a door leaves.
TEST(Planner, LeadsBackThroughANarrowPlaceThatTheRobotHasPassed) {
  Pen pen;
  pen.look_at({2.5, -0.5}, {3.5, 0.5});
  EXPECT_EQ(pen.search_for_it(false), Planner::State::NoWay);
  for (double x = 2; x <= 4; x += 0.05) pen.memory.drive({x, 0});
  EXPECT_EQ(pen.search_for_it(false), Planner::State::Found);
  EXPECT_FALSE(pen.path.unsure);
  wall(pen.map, {3, -0.25}, {3, 0.25});  // the door has closed
  EXPECT_EQ(pen.search_for_it(true), Planner::State::NoWay);
}

TEST(Planner, ALenientSearchTakesASureWayIfThereIsOne) {
  Search search;
  wall(search.map, {2, -4}, {2, -0.25});
  wall(search.map, {2, 0.25}, {2, 3});
  wall(search.map, {2, 4.2}, {2, 8});
  search.planner.start(search.world(), {0, 0}, {4, 0}, {.cost = kStepCost, .lenient = true});
  ASSERT_EQ(search.finish(), Planner::State::Found);
  EXPECT_FALSE(search.path.unsure);
}

}  // namespace
