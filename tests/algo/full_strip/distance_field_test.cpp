// tests/algo/full_strip/distance_field_test.cpp: the distances equal an exhaustive search.
#include "algo/full_strip/distance_field.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace {

using algo::DistanceField;
constexpr int kSize = DistanceField::kSize;

struct Grid {
  DistanceField field{};
  std::vector<std::uint8_t> hits = std::vector<std::uint8_t>(std::size_t{kSize} * kSize);

  std::uint8_t& at(int column, int row) {
    return hits[static_cast<std::size_t>(row) * kSize + static_cast<std::size_t>(column)];
  }
  void occupy(int column, int row) {
    at(column, row) = 3;
    field.occupy(column, row);
  }
  void free(int column, int row) {
    at(column, row) = 1;
    field.free(column, row);
  }
  /// [mm]
  int nearest(int column, int row) {
    double least = DistanceField::kReach * 1000;
    for (int y = std::max(0, row - 25); y < std::min(kSize, row + 26); ++y) {
      for (int x = std::max(0, column - 25); x < std::min(kSize, column + 26); ++x) {
        if (at(x, y) < 3) continue;
        least = std::min(least, std::hypot(x - column, y - row) * DistanceField::kCell * 1000);
      }
    }
    return static_cast<int>(std::nearbyint(least));
  }
  void finish() {
    for (int k = 0; k < 64; ++k) field.rebuild(hits, 3);
  }
};

/// In the middle of the window, over its edges and in its corners.
TEST(DistanceField, IsTheDistanceToTheNearestCell) {
  std::mt19937 random(5);
  for (const int corner : {0, 200, kSize - 96}) {
    std::uniform_int_distribution<int> place(corner, corner + 95);
    Grid grid;
    std::vector<std::pair<int, int>> cells;
    cells.resize(60);
    for (auto& [x, y] : cells) {
      x = place(random);
      y = place(random);
      grid.occupy(x, y);
    }
    for (std::size_t k = 0; k < cells.size(); k += 2) grid.free(cells[k].first, cells[k].second);
    grid.finish();
    for (int k = 0; k < 600; ++k) {
      const int x = place(random);
      const int y = place(random);
      ASSERT_EQ(grid.field.at(x, y), grid.nearest(x, y)) << x << ", " << y;
    }
  }
}

/// Until a tile is rebuilt, a distance may be too short, never too long.
TEST(DistanceField, IsNeverTooLongDuringAnUpdate) {
  Grid grid;
  for (int x = 20; x < 480; x += 4) grid.occupy(x, 100);
  for (int x = 20; x < 480; x += 8) grid.free(x, 100);
  for (int k = 0; k < 8; ++k) {
    for (int x = 20; x < 480; x += 7) ASSERT_LE(grid.field.at(x, 107), grid.nearest(x, 107));
    grid.field.rebuild(grid.hits, 3);
  }
}

TEST(DistanceField, MovesByWholeTiles) {
  Grid grid;
  grid.occupy(100, 90);
  grid.field.shift(2, -1);
  EXPECT_EQ(grid.field.at(36, 122), 0);
  EXPECT_EQ(grid.field.at(46, 122), 500);
  EXPECT_EQ(grid.field.at(100, 90), 1020);
}

}  // namespace
