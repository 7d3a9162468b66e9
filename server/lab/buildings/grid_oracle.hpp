// server/lab/buildings/grid_oracle.hpp: the shortest way of a disc in the true world, on a grid.
#pragma once

#include <optional>
#include <vector>

#include "algo/grid_search.hpp"
#include "algo/obstacle.hpp"
#include "algo/types.hpp"

namespace server::buildings {

/// A grid of kRaster over all obstacles, with the distance from each cell's middle to the nearest
/// surface. Obstacles that move are left out.
class GridOracle {
 public:
  explicit GridOracle(const std::vector<algo::Obstacle>& obstacles);

  /// [m] Distance from the middle of the cell of `p_W` to the nearest surface, at most kFarthest.
  double distance(const algo::Vec2& p_W) const;

  /// The middles of the cells from `from_W` to `to_W` on the shortest way of a disc of `radius`
  /// [m]; nothing if there is none. It ends within `reach` [m] of `to_W`. Within kLeave of `from_W`
  /// the disc may come as near to surfaces as it stands.
  std::optional<std::vector<algo::Vec2>> way(const algo::Vec2& from_W,
                                             const algo::Vec2& to_W,
                                             double radius,
                                             double reach);

  static constexpr double kFarthest = 0.6;  // [m]
  static constexpr double kLeave = 0.3;     // [m]

 private:
  algo::GridCell cell_of(const algo::Vec2& p_W) const;
  algo::Vec2 middle_W(algo::GridCell c) const;
  bool covers(algo::GridCell c) const;
  std::size_t index(algo::GridCell c) const;

  algo::Vec2 corner_W_{0, 0};
  int columns_ = 0;
  int rows_ = 0;
  std::vector<float> distances_;  // [m]
  std::vector<float> costs_;
  algo::GridSearch search_{};
};

/// [m] Length of a polyline.
double length_of(const std::vector<algo::Vec2>& way_W);

}  // namespace server::buildings
