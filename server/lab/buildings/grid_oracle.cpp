// server/lab/buildings/grid_oracle.cpp: distances around each obstacle, and A* over them.
#include "server/lab/buildings/grid_oracle.hpp"

#include <algorithm>

#include "server/lab/buildings/floor_plan.hpp"
#include "sim/obstacle_set.hpp"

namespace server::buildings {
namespace {

using algo::GridCell;
using algo::Vec2;

constexpr double kOutside = 1.0;  // [m] around all obstacles

/// The rectangle about an obstacle, `margin` [m] wider.
struct Bounds {
  Vec2 low{0, 0};
  Vec2 high{0, 0};
};
Bounds bounds_of(const algo::Obstacle& obstacle, double margin) {
  Vec2 low = obstacle.pose_W.position();
  Vec2 high = low;
  if (const auto* const round = std::get_if<algo::Cylinder>(&obstacle.shape))
    margin += round->radius;
  for (const Vec2& corner : outline_W(obstacle)) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  return {low - Vec2(margin, margin), high + Vec2(margin, margin)};
}

}  // namespace

GridOracle::GridOracle(const std::vector<algo::Obstacle>& obstacles) {
  Bounds all{Vec2(0, 0), Vec2(0, 0)};
  for (const algo::Obstacle& obstacle : obstacles) {
    const Bounds bounds = bounds_of(obstacle, kOutside);
    all.low = all.low.cwiseMin(bounds.low);
    all.high = all.high.cwiseMax(bounds.high);
  }
  corner_W_ = kRaster * (all.low / kRaster).array().floor().matrix();
  columns_ = static_cast<int>((all.high.x() - corner_W_.x()) / kRaster) + 1;
  rows_ = static_cast<int>((all.high.y() - corner_W_.y()) / kRaster) + 1;
  const std::size_t cells = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  distances_.assign(cells, static_cast<float>(kFarthest));
  sim::ObstacleSet set;
  for (const algo::Obstacle& obstacle : obstacles) {
    if (obstacle.path) continue;
    set.add(obstacle);
    const Bounds bounds = bounds_of(obstacle, kFarthest);
    const GridCell low = cell_of(bounds.low);
    const GridCell high = cell_of(bounds.high);
    for (int y = std::max(0, low.row); y <= std::min(rows_ - 1, high.row); ++y) {
      for (int x = std::max(0, low.column); x <= std::min(columns_ - 1, high.column); ++x) {
        float& nearest = distances_[index({x, y})];
        const double far = set.distance(set.size() - 1, middle_W({x, y}));
        nearest = std::min(nearest, static_cast<float>(far));
      }
    }
  }
  search_.resize(cells);
}

GridCell GridOracle::cell_of(const Vec2& p_W) const {
  return {algo::whole_below((p_W.x() - corner_W_.x()) / kRaster),
          algo::whole_below((p_W.y() - corner_W_.y()) / kRaster)};
}

Vec2 GridOracle::middle_W(GridCell c) const {
  return corner_W_ + kRaster * Vec2(c.column + 0.5, c.row + 0.5);
}

bool GridOracle::covers(GridCell c) const {
  return c.column >= 0 && c.row >= 0 && c.column < columns_ && c.row < rows_;
}

std::size_t GridOracle::index(GridCell c) const {
  return static_cast<std::size_t>(c.row) * static_cast<std::size_t>(columns_) +
         static_cast<std::size_t>(c.column);
}

double GridOracle::distance(const Vec2& p_W) const {
  const GridCell c = cell_of(p_W);
  return covers(c) ? static_cast<double>(distances_[index(c)]) : kFarthest;
}

std::optional<std::vector<Vec2>> GridOracle::way(const Vec2& from_W,
                                                 const Vec2& to_W,
                                                 double radius,
                                                 double reach) {
  const GridCell start = cell_of(from_W);
  if (!covers(start) || !covers(cell_of(to_W))) return std::nullopt;
  const double stands = distance(from_W) - kRaster;
  costs_.resize(distances_.size());
  for (std::size_t i = 0; i < costs_.size(); ++i) {
    costs_[i] = static_cast<double>(distances_[i]) < radius ? algo::CostGrid::kBlocked : 1.0F;
  }
  const int leave = static_cast<int>(kLeave / kRaster);
  for (int y = start.row - leave; y <= start.row + leave; ++y) {
    for (int x = start.column - leave; x <= start.column + leave; ++x) {
      if (covers({x, y}) && static_cast<double>(distances_[index({x, y})]) >= stands) {
        costs_[index({x, y})] = 1;
      }
    }
  }
  // The free cell nearest to the goal.
  std::optional<GridCell> end;
  double least = reach;
  const GridCell goal = cell_of(to_W);
  const int around = static_cast<int>(reach / kRaster) + 1;
  for (int y = goal.row - around; y <= goal.row + around; ++y) {
    for (int x = goal.column - around; x <= goal.column + around; ++x) {
      const double far = (middle_W({x, y}) - to_W).norm();
      if (!covers({x, y}) || far > least || costs_[index({x, y})] < 1) continue;
      least = far;
      end = GridCell{x, y};
    }
  }
  const algo::CostGrid grid{columns_, rows_, costs_};
  if (!end || !search_.find(grid, start, *end)) return std::nullopt;
  std::vector<Vec2> way_W;
  for (const GridCell& c : search_.path()) way_W.push_back(middle_W(c));
  return way_W;
}

double length_of(const std::vector<Vec2>& way_W) {
  double sum = 0;
  for (std::size_t i = 1; i < way_W.size(); ++i) sum += (way_W[i] - way_W[i - 1]).norm();
  return sum;
}

}  // namespace server::buildings
