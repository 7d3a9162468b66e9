// algo/mapping/wall_pyramid.hpp: the walls of a map as grids from fine to coarse, for searches.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "algo/mapping/submap.hpp"
#include "algo/types.hpp"

namespace algo {

/// Level h tells for a cell the best value within the square of 2^h cells to its right and above:
/// a bound for all places of a point there (Olson 2009; Hess et al. 2016).
class WallPyramid {
 public:
  static constexpr std::uint8_t kOnWall = 255;

  /// `cell` [m]; the coarsest of `levels` looks at 2^(levels - 1) cells at once.
  WallPyramid(const Submap& walls, double cell, std::size_t levels);

  double cell() const { return cell_; }
  std::size_t levels() const { return levels_.size(); }
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  /// [cells] of `p` from the corner of the grids.
  Vec2 cells_to(const Vec2& p) const { return (p - corner_) / cell_; }
  const Vec2& corner() const { return corner_; }

  std::uint8_t at(std::size_t height, int column, int row) const {
    if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return 0;
    return levels_[height][cell_index(column, row, columns_)];
  }

 private:
  void fill(const Submap& walls, int apron);

  double cell_ = 0;
  int columns_ = 0, rows_ = 0;
  Vec2 corner_{0, 0};
  std::vector<std::vector<std::uint8_t>> levels_{};
};

}  // namespace algo
