// algo/mapping/occupancy_map.hpp: what all scans of a run have shown: how often a cell returned a
// beam, how often one went through it, and where in the cell the returns lie.
#pragma once

#include <algorithm>
#include <cstdint>

#include "algo/laser_scan.hpp"
#include "algo/rolling_grid.hpp"
#include "algo/types.hpp"

namespace algo {

/// A square of W that keeps all it has seen: where nothing is forgotten, a robot that comes back
/// finds the walls it saw at first. The rolling grid of the certainty grid, standing still.
///
/// A cell's occupancy is hits / (hits + passes), the share of the beams that came to it and ended
/// there (counting model; Haehnel, Burgard, Thrun 2003). Everything is allocated in the
/// constructor.
class OccupancyMap {
 public:
  struct Tally {
    float x = 0, y = 0;        // [m] mean of the hits, from the cell's centre
    std::uint16_t hits = 0;    // beams that ended here
    std::uint16_t passes = 0;  // beams that went through
    bool known() const { return hits > 0 || passes > 0; }
    /// Walls met at a slant are passed often, things that went away much oftener.
    bool occupied() const { return hits > 0 && 4 * hits >= passes; }
  };

  /// `side` cells of edge `cell` [m] in x and in y about `centre_W`; what lies outside is not kept.
  OccupancyMap(double cell, int side, const Vec2& centre_W);

  /// Enters the Ok beams of `scan`, taken by a scanner at `sensor_W`, those up to `reach` [m].
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
  /// Counted from that corner.
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
