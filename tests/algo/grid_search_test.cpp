// tests/algo/grid_search_test.cpp: A* finds least-cost paths, or reports that there is none.
#include "algo/grid_search.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "tests/algo/allocations.hpp"
#include <gtest/gtest.h>

namespace {

using algo::CostGrid;
using algo::GridCell;

/// A grid drawn with '#' for blocked, digits for costs and '.' for 1; the first row is row 0.
struct Drawn {
  std::vector<float> costs{};
  int columns = 0;
  int rows = 0;

  explicit Drawn(const std::vector<std::string>& lines)
      : columns(static_cast<int>(lines.front().size())), rows(static_cast<int>(lines.size())) {
    for (const std::string& line : lines) {
      for (const char c : line) {
        const float cost = c == '.' ? 1.0F : static_cast<float>(c - '0');
        costs.push_back(c == '#' ? CostGrid::kBlocked : cost);
      }
    }
  }
  CostGrid view() const { return {columns, rows, costs}; }
};

float cost_of(const CostGrid& grid, std::span<const GridCell> path) {
  float sum = 0;
  for (std::size_t k = 1; k < path.size(); ++k) {
    const bool diagonal = path[k].column != path[k - 1].column && path[k].row != path[k - 1].row;
    sum += (diagonal ? std::sqrt(2.0F) : 1.0F) * grid.costs[grid.index(path[k])];
  }
  return sum;
}

/// Least cost by relaxing every edge until nothing changes.
float exhaustive(const CostGrid& grid, GridCell start, GridCell goal) {
  std::vector<float> best(grid.costs.size(), std::numeric_limits<float>::infinity());
  best[grid.index(start)] = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (int row = 0; row < grid.rows; ++row) {
      for (int column = 0; column < grid.columns; ++column) {
        for (int dr = -1; dr <= 1; ++dr) {
          for (int dc = -1; dc <= 1; ++dc) {
            const GridCell next{column + dc, row + dr};
            if ((dr == 0 && dc == 0) || grid.blocked(next)) continue;
            const bool cut = grid.blocked({column + dc, row}) || grid.blocked({column, row + dr});
            if (dr != 0 && dc != 0 && cut) continue;
            const float length = dr != 0 && dc != 0 ? std::sqrt(2.0F) : 1.0F;
            const float cost =
                best[grid.index({column, row})] + length * grid.costs[grid.index(next)];
            if (!(cost < best[grid.index(next)])) continue;
            best[grid.index(next)] = cost;
            changed = true;
          }
        }
      }
    }
  }
  return best[grid.index(goal)];
}

TEST(GridSearch, GoesRoundAWallWithoutCuttingItsCorner) {
  const Drawn drawn({".....", ".###.", "....."});
  algo::GridSearch search;
  search.resize(drawn.costs.size());
  ASSERT_TRUE(search.find(drawn.view(), {2, 0}, {2, 2}));
  EXPECT_EQ(search.path().size(), 7U);
  EXPECT_FLOAT_EQ(cost_of(drawn.view(), search.path()), 6);
}

TEST(GridSearch, PrefersALongerCheaperWay) {
  const Drawn drawn({".9.", ".9.", "..."});
  algo::GridSearch search;
  search.resize(drawn.costs.size());
  ASSERT_TRUE(search.find(drawn.view(), {0, 0}, {2, 0}));
  EXPECT_LT(cost_of(drawn.view(), search.path()), 9);
}

TEST(GridSearch, WithoutAPathItLeadsToTheNearestReachableCell) {
  const Drawn drawn({"...#.", "...#.", "...#."});
  algo::GridSearch search;
  search.resize(drawn.costs.size());
  EXPECT_FALSE(search.find(drawn.view(), {0, 0}, {4, 2}));
  ASSERT_FALSE(search.path().empty());
  EXPECT_EQ(search.path().back(), (GridCell{2, 2}));
  EXPECT_FALSE(search.find(drawn.view(), {0, 0}, {3, 1})) << "a blocked goal";
  EXPECT_EQ(search.path().back(), (GridCell{2, 1}));
}

TEST(GridSearch, StartMayEqualGoalAndBothMustBeInside) {
  const Drawn drawn({"..", ".."});
  algo::GridSearch search;
  search.resize(drawn.costs.size());
  EXPECT_TRUE(search.find(drawn.view(), {1, 1}, {1, 1}));
  EXPECT_EQ(search.path().size(), 1U);
  EXPECT_FALSE(search.find(drawn.view(), {1, 1}, {2, 1}));
  EXPECT_TRUE(search.path().empty());
  EXPECT_FALSE(search.find(drawn.view(), {-1, 0}, {1, 1}));
}

TEST(GridSearch, CostEqualsThatOfAnExhaustiveSearch) {
  std::mt19937_64 random(3);
  std::uniform_int_distribution<int> kind(0, 9);
  algo::GridSearch search;
  search.resize(12 * 9);
  int reached = 0;
  for (int k = 0; k < 100; ++k) {
    std::vector<std::string> lines(9, std::string(12, '.'));
    for (std::string& line : lines) {
      for (char& c : line) {
        const int drawn = kind(random);
        c = drawn < 3 ? '#' : static_cast<char>('1' + drawn % 5);
      }
    }
    lines[0][0] = '1';
    lines[8][11] = '1';
    const Drawn drawn(lines);
    const float least = exhaustive(drawn.view(), {0, 0}, {11, 8});
    const bool found = search.find(drawn.view(), {0, 0}, {11, 8});
    ASSERT_EQ(found, std::isfinite(least)) << k;
    if (!found) continue;
    ++reached;
    EXPECT_NEAR(cost_of(drawn.view(), search.path()), least, 1e-3) << k;
  }
  EXPECT_GT(reached, 20);
}

TEST(GridSearch, AllocatesNothingAfterResize) {
  std::vector<float> costs(static_cast<std::size_t>(81 * 81), 1.0F);
  for (std::size_t k = 0; k < costs.size(); k += 7) costs[k] = 4;
  for (std::size_t row = 0; row < 80; ++row) costs[row * 81 + 40] = CostGrid::kBlocked;
  algo::GridSearch search;
  search.resize(costs.size());
  const std::size_t before = allocations::count();
  EXPECT_TRUE(search.find({81, 81, costs}, {0, 0}, {80, 0}));
  EXPECT_EQ(allocations::count(), before);
}

}  // namespace
