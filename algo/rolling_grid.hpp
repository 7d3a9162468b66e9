// algo/rolling_grid.hpp: a square of cells that follows the robot and forgets the cells that it
// leaves.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "algo/layer.hpp"
#include "algo/types.hpp"

namespace algo {

/// Cell (i, j) spans [i edge, (i + 1) edge) x [j edge, (j + 1) edge) of W.
struct Cell {
  int i = 0;
  int j = 0;
  bool operator==(const Cell&) const = default;
};

/// side x side cells of type T, fixed to W. Cells never move in memory: cell (i, j) lies at (i mod
/// side, j mod side). Allocates in the constructor only.
template <typename T>
class RollingGrid {
 public:
  RollingGrid(double edge, int side)
      : edge_(edge), side_(side), cells_(static_cast<std::size_t>(side * side)) {}

  double edge() const { return edge_; }
  int side() const { return side_; }
  Cell first() const { return first_; }

  void clear() { std::fill(cells_.begin(), cells_.end(), T{}); }

  Cell cell_of(const Vec2& p_W) const { return {index(p_W.x()), index(p_W.y())}; }
  Vec2 centre(Cell c) const { return {(c.i + 0.5) * edge_, (c.j + 0.5) * edge_}; }
  bool covers(Cell c) const {
    return c.i >= first_.i && c.i < first_.i + side_ && c.j >= first_.j && c.j < first_.j + side_;
  }
  /// The cell must be covered.
  T& operator[](Cell c) { return cells_[place(c)]; }
  const T& operator[](Cell c) const { return cells_[place(c)]; }

  /// Moves the square so that the cell of `p_W` is its middle. New cells are T{}.
  void centre_on(const Vec2& p_W) {
    const Cell middle = cell_of(p_W);
    const Cell next = {middle.i - side_ / 2, middle.j - side_ / 2};
    const int di = next.i - first_.i;
    const int dj = next.j - first_.j;
    const Cell before = first_;
    first_ = next;
    ring_ = {wrapped(next.i), wrapped(next.j)};
    if (std::abs(di) >= side_ || std::abs(dj) >= side_) {
      clear();
      return;
    }
    for (int k = 0; k < std::abs(di); ++k) clear_column(di > 0 ? before.i + side_ + k : next.i + k);
    for (int k = 0; k < std::abs(dj); ++k) clear_row(dj > 0 ? before.j + side_ + k : next.j + k);
  }

  /// Draws the grid as a layer of the kind Grid, with byte(cell) for every cell.
  template <typename Byte>
  void show(Layer& layer, Byte&& byte) const {
    put(layer, first_.i * edge_, first_.j * edge_, edge_, side_);
    layer.cells.resize(cells_.size());
    std::size_t at = 0;
    for (int j = first_.j; j < first_.j + side_; ++j) {
      for (int i = first_.i; i < first_.i + side_; ++i) layer.cells[at++] = byte((*this)[{i, j}]);
    }
  }

 private:
  int index(double x) const {
    constexpr double kFarthest = 1e9;  // fits an int, with room for a window about it
    return static_cast<int>(std::clamp(std::floor(x / edge_), -kFarthest, kFarthest));
  }
  int wrapped(int k) const { return (k % side_ + side_) % side_; }
  /// A covered cell is less than one turn of the ring from the first, so no division is needed.
  int turned(int k, int first, int at) const {
    const int place = k - first + at;
    return place < side_ ? place : place - side_;
  }
  std::size_t place(Cell c) const {
    const int at = turned(c.j, first_.j, ring_.j) * side_ + turned(c.i, first_.i, ring_.i);
    return static_cast<std::size_t>(at);
  }
  void clear_column(int i) {
    for (int j = first_.j; j < first_.j + side_; ++j) (*this)[{i, j}] = T{};
  }
  void clear_row(int j) {
    for (int i = first_.i; i < first_.i + side_; ++i) (*this)[{i, j}] = T{};
  }

  double edge_ = 0;  // [m]
  int side_ = 0;
  Cell first_{};  // the covered cell with the least i and j
  Cell ring_{};   // its column and row in memory
  std::vector<T> cells_{};
};

}  // namespace algo
