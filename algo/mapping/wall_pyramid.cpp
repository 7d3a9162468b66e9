// algo/mapping/wall_pyramid.cpp: each level from the one below.
#include "algo/mapping/wall_pyramid.hpp"

#include <algorithm>
#include <utility>

namespace algo {
namespace {

constexpr std::uint8_t kBesideWall = 170;

}  // namespace

WallPyramid::WallPyramid(const Submap& walls, double cell, std::size_t levels) : cell_(cell) {
  fill(walls, 1 << (levels - 1));  // coarse levels need cells before the first wall
  const auto width = static_cast<std::size_t>(columns_);
  for (std::size_t height = 1; height < levels; ++height) {
    const int half = 1 << (height - 1);
    const std::vector<std::uint8_t>& below = levels_.back();
    std::vector<std::uint8_t> wide(below.size(), 0);
    for (int row = 0; row < rows_; ++row) {
      const std::size_t here = static_cast<std::size_t>(row) * width;
      const std::size_t above = static_cast<std::size_t>(std::min(row + half, rows_ - 1)) * width;
      for (int column = 0; column < columns_; ++column) {
        const auto left = static_cast<std::size_t>(column);
        const auto right = static_cast<std::size_t>(std::min(column + half, columns_ - 1));
        wide[here + left] = std::max(std::max(below[here + left], below[here + right]),
                                     std::max(below[above + left], below[above + right]));
      }
    }
    levels_.push_back(std::move(wide));
  }
}

void WallPyramid::fill(const Submap& walls, int apron) {
  Vec2 low(0, 0);
  Vec2 high(0, 0);
  bool first = true;
  for (const Eigen::Vector2f& wall : walls.walls()) {
    const Vec2 p = wall.cast<double>();
    low = first ? p : low.cwiseMin(p).eval();
    high = first ? p : high.cwiseMax(p).eval();
    first = false;
  }
  corner_ = low - Vec2::Constant(cell_ * (apron + 1));
  const Vec2 size = cells_to(high);
  columns_ = static_cast<int>(size.x()) + 3;
  rows_ = static_cast<int>(size.y()) + 3;
  std::vector<std::uint8_t>& cells =
      levels_.emplace_back(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0);
  for (const Eigen::Vector2f& wall : walls.walls()) {
    const Vec2 off = cells_to(wall.cast<double>());
    const int column = static_cast<int>(off.x());
    const int row = static_cast<int>(off.y());
    for (int dj = -1; dj <= 1; ++dj) {
      for (int di = -1; di <= 1; ++di) {
        std::uint8_t& beside = cells[cell_index(column + di, row + dj, columns_)];
        beside = std::max(beside, di == 0 && dj == 0 ? kOnWall : kBesideWall);
      }
    }
  }
}

}  // namespace algo
