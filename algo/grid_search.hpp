// algo/grid_search.hpp: A* over a grid of cell costs with eight neighbours per cell.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace algo {

struct GridCell {
  int column = 0;
  int row = 0;
  bool operator==(const GridCell&) const = default;
};

/// Cost of entering each cell, row-major, at least 1 per cell edge travelled; kBlocked: impassable.
struct CostGrid {
  static constexpr float kBlocked = -1;
  int columns = 0;
  int rows = 0;
  std::span<const float> costs{};

  bool covers(GridCell c) const {
    return c.column >= 0 && c.column < columns && c.row >= 0 && c.row < rows;
  }
  std::size_t index(GridCell c) const {
    return static_cast<std::size_t>(c.row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(c.column);
  }
  bool blocked(GridCell c) const { return !covers(c) || !(costs[index(c)] >= 1); }
};

/// Finds least-cost paths. A step costs its length in cells (1 or sqrt 2) times the cost of the
/// entered cell. A diagonal step needs both cells beside it passable, so that it cuts no corner.
/// Allocates in resize() only. Deterministic: ties are broken by the order of insertion.
class GridSearch {
 public:
  /// Makes room for grids of up to `cells` cells.
  void resize(std::size_t cells);

  /// True if `goal` is reachable. path() then leads from start to goal; otherwise it leads to the
  /// reachable cell nearest to the goal. The start's own cost is ignored. A start or goal outside
  /// the grid gives false and an empty path.
  bool find(const CostGrid& grid, GridCell start, GridCell goal);

  std::span<const GridCell> path() const { return path_; }

 private:
  struct Open {
    float total = 0;  // cost so far plus a lower bound of the rest
    std::uint32_t order = 0;
    std::uint32_t cell = 0;
    /// Of equals, the one inserted later is larger.
    bool operator>(const Open& other) const {
      return total != other.total ? total > other.total : order > other.order;
    }
  };
  void begin();
  void push(float total, std::size_t cell);
  std::size_t pop();
  void trace(const CostGrid& grid, std::size_t from, std::size_t to);

  // A cell's cost and parent are valid only where its mark equals the current search_.
  std::vector<float> cost_{};
  std::vector<std::uint32_t> parent_{};
  std::vector<std::uint32_t> mark_{};
  std::vector<std::uint8_t> closed_{};
  std::vector<Open> open_{};  // a heap, smallest total first
  std::vector<GridCell> path_{};
  std::uint32_t search_ = 0;
  std::uint32_t pushed_ = 0;
};

}  // namespace algo
