// algo/baselines/histogram_grid.hpp: the histogram grid of VFF and VFH, which counts the readings
// of each cell (Borenstein and Koren 1989, 1991; equations.md F.4).
#pragma once

#include <algorithm>
#include <cstdint>

#include "algo/baselines/returns.hpp"
#include "algo/rolling_grid.hpp"

namespace algo {

/// Certainty values C of 0..15. A reading adds one to the cell of its return, and nothing lowers a
/// cell: an obstacle that leaves stays in the grid until the robot has driven on.
class HistogramGrid {
 public:
  static constexpr double kCell = 0.1;          // [m]
  static constexpr int kWindow = 33;            // cells of the active window's edge, odd
  static constexpr int kSide = 81;              // [D] cells remembered: 4 m around the robot
  static constexpr std::uint8_t kCertain = 15;  // largest C

  void clear() {
    cells_.clear();
    is_new_.reset();
  }
  void centre_on(const Vec2& p_W) { cells_.centre_on(p_W); }

  /// Adds one reading with a return at `point_W`.
  void add(const Vec2& point_W) {
    const Cell cell = cells_.cell_of(point_W);
    if (!cells_.covers(cell)) return;
    std::uint8_t& c = cells_[cell];
    c = std::min<std::uint8_t>(kCertain, static_cast<std::uint8_t>(c + 1));
  }

  /// Follows the robot and adds every return of a new scan or sonar ring.
  void sense(const ControlInput& in) {
    centre_on(in.odometry.pose.position());
    if (!is_new_(*in.scene)) return;
    for_each_return(in, [this](const Vec2& point_W) { add(point_W); });
  }

  /// Calls visit(offset, C) for every cell of the active window with C > 0. `offset` [m] leads from
  /// `robot_W` to the cell's centre. The grid must be centred on the robot.
  template <typename Visit>
  void for_each_in_window(const Vec2& robot_W, Visit&& visit) const {
    constexpr int kHalf = kWindow / 2;
    const Cell robot = cells_.cell_of(robot_W);
    for (int j = robot.j - kHalf; j <= robot.j + kHalf; ++j) {
      for (int i = robot.i - kHalf; i <= robot.i + kHalf; ++i) {
        const std::uint8_t c = cells_[{i, j}];
        if (c > 0) visit(Vec2(cells_.centre({i, j}) - robot_W), static_cast<double>(c));
      }
    }
  }

  /// A cell without readings is shown as unknown: the grid has no free cells.
  void show(const ControlInput& in, ControlOutput& out) const {
    Layer& layer = add_layer(out.layers, kShown);
    if (!in.grids) return;
    cells_.show(layer, [](std::uint8_t c) {
      return c == 0 ? kUnknownCell : static_cast<std::uint8_t>(127 + c * 127 / kCertain);
    });
  }

 private:
  static constexpr LayerInfo kShown{.name = "histogram.grid",
                                    .label = "Histogram grid",
                                    .kind = LayerKind::Grid,
                                    .tone = Tone::External};
  RollingGrid<std::uint8_t> cells_{kCell, kSide};
  NewPicture is_new_{};
};

}  // namespace algo
