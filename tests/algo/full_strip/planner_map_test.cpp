// tests/algo/full_strip/planner_map_test.cpp: plans over a known map, which counts only where the
// robot has not looked.
#include <cmath>
#include <vector>

#include "tests/algo/allocations.hpp"
#include "tests/algo/full_strip/walls.hpp"
#include <gtest/gtest.h>

#include "algo/drawn_space.hpp"
#include "algo/full_strip/planner.hpp"

namespace {

using algo::BuildingMemory;
using algo::DrawnSpace;
using algo::DrawnWalls;
using algo::LocalMap;
using algo::Planner;
using algo::Vec2;

constexpr algo::StepCost kHull{.half_width = 0.28, .least = 0.3};

/// A map of free space with walls all round, in which more walls are drawn.
class Sheet {
 public:
  Sheet(const Vec2& low_W, const Vec2& high_W) : low_(cell(low_W)) {
    const BuildingMemory::Cell high = cell(high_W);
    columns_ = high.column - low_.column + 1;
    rows_ = high.row - low_.row + 1;
    cells_.assign(static_cast<std::size_t>(columns_ * rows_), DrawnSpace::kMost);
    draw(low_W, {low_W.x(), high_W.y()}).draw({high_W.x(), low_W.y()}, high_W);
    draw(low_W, {high_W.x(), low_W.y()}).draw({low_W.x(), high_W.y()}, high_W);
  }
  /// The walls and unknown places fill whole cells.
  Sheet& draw(const Vec2& low_W, const Vec2& high_W, std::uint8_t cm = 0) {
    const BuildingMemory::Cell high = cell(high_W);
    for (int row = cell(low_W).row; row <= high.row; ++row) {
      for (int column = cell(low_W).column; column <= high.column; ++column) {
        cells_[static_cast<std::size_t>((row - low_.row) * columns_ + column - low_.column)] = cm;
      }
    }
    return *this;
  }
  DrawnSpace space() const { return {low_.column, low_.row, columns_, rows_, cells_}; }

 private:
  static BuildingMemory::Cell cell(const Vec2& p_W) { return BuildingMemory::cell_of(p_W); }

  BuildingMemory::Cell low_;
  int columns_ = 0, rows_ = 0;
  std::vector<std::uint8_t> cells_{};
};

struct MapSearch {
  explicit MapSearch(const Sheet& sheet) : drawn(sheet.space()) { planner.hold(drawn); }

  DrawnSpace drawn;
  LocalMap map{};
  BuildingMemory memory{};
  Planner planner{};
  Planner::Path path{};

  Planner::State find(const Vec2& from_W, const Vec2& to_W, DrawnWalls walls = DrawnWalls::Shut) {
    const algo::PlanWorld world{map, memory, &drawn};
    planner.start(world, from_W, to_W, {.cost = kHull, .try_tight = true, .walls = walls});
    Planner::State state = planner.state();
    for (int k = 0; k < 50'000 && state == Planner::State::Searching; ++k) {
      state = planner.search(world, 100);
    }
    planner.path(world, path);
    return state;
  }
  /// The robot has looked through the rectangle and seen nothing.
  void look(const Vec2& low_W, const Vec2& high_W) {
    const BuildingMemory::Cell low = BuildingMemory::cell_of(low_W);
    const BuildingMemory::Cell high = BuildingMemory::cell_of(high_W);
    for (int row = low.row; row <= high.row; ++row) {
      for (int column = low.column; column <= high.column; ++column) {
        memory.get(BuildingMemory::tile_of(column), BuildingMemory::tile_of(row))
            .seen[BuildingMemory::within({column, row})] = 1;
      }
    }
  }
  double length() const {
    double sum = 0;
    for (std::size_t i = 1; i < path.points_W.size(); ++i) {
      sum += (path.points_W[i] - path.points_W[i - 1]).norm();
    }
    return sum;
  }
};

/// A dead end: the wall at x = 8 is open far aside only.
Sheet dead_end() {
  return Sheet({-5, -20}, {30, 20}).draw({8, -20}, {8.1, 15});
}

TEST(PlannerMap, GoesRoundAWallThatOnlyTheMapShows) {
  MapSearch search(dead_end());
  ASSERT_EQ(search.find({0, 0}, {20, 0}), Planner::State::Found);
  EXPECT_GT(search.length(), 35);
  EXPECT_FALSE(search.planner.goal_taken());
}

TEST(PlannerMap, ItsOwnSightOfAGapCountsMoreThanADrawnWall) {
  MapSearch search(dead_end());
  search.look({7, -1}, {9, 1});
  ASSERT_EQ(search.find({0, 0}, {20, 0}), Planner::State::Found);
  EXPECT_LT(search.length(), 22);
}

TEST(PlannerMap, ItsOwnSightOfAWallCountsMoreThanADrawnGap) {
  MapSearch search(Sheet({-5, -20}, {30, 20}).draw({8, 2}, {8.1, 20}).draw({8, -20}, {8.1, -2}));
  ASSERT_EQ(search.find({0, 0}, {20, 0}), Planner::State::Found);
  walls::wall(search.map, {8, -2}, {8, 2});
  EXPECT_EQ(search.find({0, 0}, {20, 0}), Planner::State::NoWay);
}

TEST(PlannerMap, FindsNoWayIntoADrawnRoomUnlessItsWallsMayBeGone) {
  Sheet sheet({-5, -20}, {40, 20});
  for (const double y : {-3.0, 3.0}) sheet.draw({25, y}, {31, y + 0.1});
  for (const double x : {25.0, 31.0}) sheet.draw({x, -3}, {x + 0.1, 3.1});
  MapSearch search(sheet);
  EXPECT_EQ(search.find({0, 0}, {28, 0}), Planner::State::NoWay);
  ASSERT_EQ(search.find({0, 0}, {28, 0}, DrawnWalls::Priced), Planner::State::Found);
  EXPECT_LT(search.length(), 30);
}

TEST(PlannerMap, AGoalInADrawnWallIsReplacedByThePlaceBesideIt) {
  MapSearch search(Sheet({-5, -20}, {60, 20}).draw({50, -2}, {52, 2}));
  ASSERT_EQ(search.find({0, 0}, {51, 0}), Planner::State::Found);
  EXPECT_TRUE(search.planner.goal_taken());
  EXPECT_NEAR((search.path.points_W.back() - Vec2(51, 0)).norm(), 1.3, 0.5);
  search.look({49, -3}, {53, 3});  // it is gone
  ASSERT_EQ(search.find({0, 0}, {51, 0}), Planner::State::Found);
  EXPECT_FALSE(search.planner.goal_taken());
}

TEST(PlannerMap, PrefersSpaceThatTheMapShowsToSpaceNobodyKnows) {
  MapSearch search(Sheet({-5, -20}, {60, 20}).draw({20, -20}, {40, 0.4}, DrawnSpace::kUnknown));
  ASSERT_EQ(search.find({0, 0}, {50, 0}), Planner::State::Found);
  for (const Vec2& p : search.path.points_W) {
    EXPECT_TRUE(p.x() < 21 || p.x() > 39 || p.y() > 0.3) << p.x() << ' ' << p.y();
  }
}

TEST(PlannerMap, ReachesAcrossABuildingOfManyHundredMetres) {
  Sheet sheet({-5, -60}, {400, 60});
  for (int k = 0; k < 6; ++k) {  // each wall is open at the other end
    const double x = 50 + 60 * k;
    if (k % 2 == 0) {
      sheet.draw({x, -60}, {x + 0.1, 50});
    } else {
      sheet.draw({x, -50}, {x + 0.1, 60});
    }
  }
  MapSearch search(sheet);
  EXPECT_GT(search.planner.farthest(), 390);
  ASSERT_EQ(search.find({0, 0}, {390, 0}), Planner::State::Found);
  EXPECT_LT((search.path.points_W.back() - Vec2(390, 0)).norm(), 0.1);
  EXPECT_GT(search.length(), 600);
}

TEST(PlannerMap, ASearchAllocatesNothing) {
  MapSearch search(dead_end());
  const algo::PlanWorld world{search.map, search.memory, &search.drawn};
  const std::size_t before = allocations::count();
  search.planner.start(world, {0, 0}, {20, 0}, {.cost = kHull, .try_tight = true});
  while (search.planner.search(world, 400) == Planner::State::Searching) continue;
  EXPECT_EQ(search.planner.state(), Planner::State::Found);
  EXPECT_EQ(allocations::count(), before);
}

TEST(PlannerMap, AStraightLineStopsAtADrawnWall) {
  MapSearch search(dead_end());
  const algo::PlanWorld world{search.map, search.memory, &search.drawn};
  algo::Recycled<Vec2> path;
  for (const Vec2& p : {Vec2(0, 0), Vec2(6, 16), Vec2(10, 17), Vec2(16, 0)}) path.push_back(p);
  algo::straighten(world, 0.7, 0.3, path);
  EXPECT_GT(path.size(), 2U);
  search.look({-5, -20}, {30, 20});
  algo::straighten(world, 0.7, 0.3, path);
  EXPECT_EQ(path.size(), 2U);
}

}  // namespace
