// algo/grid_search.cpp: A* with a lazy binary heap.
#include "algo/grid_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numbers>

namespace algo {
namespace {

constexpr float kDiagonal = std::numbers::sqrt2_v<float>;
constexpr std::size_t kNeighbours = 8;
constexpr std::array<GridCell, kNeighbours> kSteps{
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

/// The length of the shortest eight-neighbour path over free cells. It never exceeds the true cost,
/// since every cell costs at least 1.
float least_cost(GridCell a, GridCell b) {
  const auto across = static_cast<float>(std::abs(a.column - b.column));
  const auto along = static_cast<float>(std::abs(a.row - b.row));
  return std::max(across, along) + (kDiagonal - 1) * std::min(across, along);
}

GridCell at(const CostGrid& grid, std::size_t index) {
  const auto columns = static_cast<std::size_t>(grid.columns);
  return {static_cast<int>(index % columns), static_cast<int>(index / columns)};
}

/// True if `step` from `c` is possible.
bool passable(const CostGrid& grid, GridCell c, GridCell step) {
  if (grid.blocked({c.column + step.column, c.row + step.row})) return false;
  if (step.column == 0 || step.row == 0) return true;
  return !grid.blocked({c.column + step.column, c.row}) &&
         !grid.blocked({c.column, c.row + step.row});
}

}  // namespace

void GridSearch::resize(std::size_t cells) {
  cost_.assign(cells, 0);
  parent_.assign(cells, 0);
  mark_.assign(cells, 0);
  closed_.assign(cells, 0);
  // Each neighbour that reaches a cell at a lower cost pushes it once.
  open_.reserve(kNeighbours * cells + 1);
  path_.reserve(cells);
  search_ = 0;
}

void GridSearch::begin() {
  open_.clear();
  path_.clear();
  pushed_ = 0;
  if (++search_ == 0) {  // the counter wrapped: old marks could match new ones
    std::fill(mark_.begin(), mark_.end(), 0U);
    search_ = 1;
  }
}

void GridSearch::push(float total, std::size_t cell) {
  open_.push_back({total, pushed_++, static_cast<std::uint32_t>(cell)});
  std::push_heap(open_.begin(), open_.end(), std::greater{});
}

std::size_t GridSearch::pop() {
  std::pop_heap(open_.begin(), open_.end(), std::greater{});
  const std::size_t cell = open_.back().cell;
  open_.pop_back();
  return cell;
}

void GridSearch::trace(const CostGrid& grid, std::size_t from, std::size_t to) {
  for (std::size_t c = to; c != from; c = parent_[c]) path_.push_back(at(grid, c));
  path_.push_back(at(grid, from));
  std::reverse(path_.begin(), path_.end());
}

bool GridSearch::find(const CostGrid& grid, GridCell start, GridCell goal) {
  begin();
  if (!grid.covers(start) || !grid.covers(goal)) return false;
  const auto reach = [&](std::size_t cell, float cost, std::size_t parent) {
    mark_[cell] = search_;
    closed_[cell] = 0;
    cost_[cell] = cost;
    parent_[cell] = static_cast<std::uint32_t>(parent);
    push(cost + least_cost(at(grid, cell), goal), cell);
  };
  const std::size_t first = grid.index(start);
  const std::size_t last = grid.index(goal);
  reach(first, 0, first);
  std::size_t nearest = first;
  float least = least_cost(start, goal);
  while (!open_.empty()) {
    const std::size_t here = pop();
    if (closed_[here] != 0) continue;  // an older, costlier way to it
    closed_[here] = 1;
    const GridCell cell = at(grid, here);
    if (least_cost(cell, goal) < least) {
      least = least_cost(cell, goal);
      nearest = here;
    }
    if (here == last) break;
    for (const GridCell& step : kSteps) {
      if (!passable(grid, cell, step)) continue;
      const std::size_t next = grid.index({cell.column + step.column, cell.row + step.row});
      const float length = step.column != 0 && step.row != 0 ? kDiagonal : 1.0F;
      const float cost = cost_[here] + length * grid.costs[next];
      const bool known = mark_[next] == search_;
      if (!known || (closed_[next] == 0 && cost < cost_[next])) reach(next, cost, here);
    }
  }
  trace(grid, first, nearest);
  return nearest == last;
}

}  // namespace algo
