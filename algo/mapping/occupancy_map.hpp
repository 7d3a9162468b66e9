// algo/mapping/occupancy_map.hpp: an occupancy map of all scans of a run. Each cell counts the
// beams that ended in it and that passed through it, and averages its returns.
#pragma once

#include <algorithm>
#include <cstdint>

#include "algo/laser_scan.hpp"
#include "algo/rolling_grid.hpp"
#include "algo/types.hpp"

namespace algo {

/// A square of W that forgets nothing, so that a returning robot finds the walls that it saw first.
/// Like the certainty grid's rolling grid, but fixed.
///
/// A cell's occupancy is hits / (hits + passes): of the beams that reached it, the share that ended
/// there (counting model; Haehnel, Burgard, Thrun 2003). Allocates in the constructor only.
class OccupancyMap {
 public:
  struct Tally {
    float x = 0, y = 0;        // [m] mean of the hits, from the cell's centre
    std::uint16_t hits = 0;    // beams that ended here
    std::uint16_t passes = 0;  // beams that went through
    bool known() const { return hits > 0 || passes > 0; }
    /// Beams pass often through cells of walls seen at a slant, and far more often through those of
    /// things that left.
    bool occupied() const { return hits > 0 && 4 * hits >= passes; }
  };

  /// `side` cells of edge `cell` [m] in x and in y about `centre_W`; ignores everything outside.
  OccupancyMap(double cell, int side, const Vec2& centre_W);

  /// Enters the Ok beams of `scan` up to `reach` [m], taken by a scanner at `sensor_W`.
  void insert(const LaserScan& scan, const Pose2& sensor_W, double reach);

  /// Calls `see(point_W)` for each occupied cell of the square of half edge `reach` [m] about
  /// `p_W`, with the mean of its hits.
  template <typename See>
  void each_near(const Vec2& p_W, double reach, See&& see) const {
    const Cell low = clamped(cells_.cell_of(p_W - Vec2(reach, reach)));
    const Cell high = clamped(cells_.cell_of(p_W + Vec2(reach, reach)));
    for (int j = low.j; j <= high.j; ++j) {
      for (int i = low.i; i <= high.i; ++i) {
        const Tally& tally = cells_[{i, j}];
        if (tally.occupied()) see(mean_W({i, j}, tally));
      }
    }
  }

  double cell_edge() const { return cells_.edge(); }
  int side() const { return cells_.side(); }
  /// [m] The outer corner of the cell of column 0 and row 0.
  Vec2 corner_W() const {
    return {cells_.first().i * cells_.edge(), cells_.first().j * cells_.edge()};
  }
  /// Columns and rows count from that corner.
  const Tally& at(int column, int row) const {
    return cells_[{cells_.first().i + column, cells_.first().j + row}];
  }

 private:
  Vec2 mean_W(Cell at, const Tally& tally) const {
    return cells_.centre(at) + Vec2(static_cast<double>(tally.x), static_cast<double>(tally.y));
  }
  Cell clamped(Cell at) const {
    const Cell first = cells_.first();
    const int last = cells_.side() - 1;
    return {std::clamp(at.i, first.i, first.i + last), std::clamp(at.j, first.j, first.j + last)};
  }
  void pass(const Vec2& from_W, const Vec2& to_W);
  void hit(const Vec2& point_W);

  RollingGrid<Tally> cells_;
};

}  // namespace algo
