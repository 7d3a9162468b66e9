// algo/baselines/certainty_grid.hpp: a grid of certainties that each cell is empty or occupied, and
// a path over it (Moravec and Elfes 1985; equations.md F.2).
#pragma once

#include <vector>

#include "algo/baselines/baseline.hpp"
#include "algo/baselines/returns.hpp"
#include "algo/grid_search.hpp"
#include "algo/rolling_grid.hpp"

namespace algo {

/// One range reading as a sector of the plane.
struct RangeSector {
  Pose2 mount_W{};     // apex and axis
  double width = 0;    // [rad] w, whole beam, below pi / 2
  double range = 0;    // [m] R
  double nearest = 0;  // [m] R_min: no measurement below it
  bool hit = false;    // R is a return; false: empty as far as R
};

/// p_E = (1 - ((s - R_min) / (R - e - R_min))^2) (1 - (2 a / w)^2) for R_min <= s <= R - e, else 0:
/// the certainty that a cell at distance `s` and angle `a` off the axis is empty. e = 0.1 m [D].
double empty_probability(const RangeSector& sector, double s, double a);
/// p_O = (1 - ((s - R) / e)^2) (1 - (2 a / w)^2) for |s - R| <= e, else 0.
double occupied_probability(const RangeSector& sector, double s, double a);

/// The map. A reading adds E := E + p_E - E p_E, then O := O + q - O q. Here q = p_O (1 - E),
/// normalised to the sum 1 over the arc. A laser beam's arc is one to three cells, which become
/// certain at once.
class CertaintyGrid {
 public:
  static constexpr double kCell = 0.1;  // [m]
  static constexpr int kSide = 81;      // [D] cells remembered: 4 m around the robot

  CertaintyGrid();
  void clear() {
    cells_.clear();
    is_new_.reset();
  }
  void centre_on(const Vec2& p_W) { cells_.centre_on(p_W); }
  void add(const RangeSector& sector);
  /// Enters every beam of a new scan or sonar ring.
  void sense(const ControlInput& in);

  Cell first() const { return cells_.first(); }
  Cell cell_of(const Vec2& p_W) const { return cells_.cell_of(p_W); }
  Vec2 centre(Cell c) const { return cells_.centre(c); }
  /// O where O >= E, else -E: 1 surely occupied, -1 surely empty, 0 unknown.
  double certainty(Cell c) const { return cells_[c].value(); }
  void show(Layer& layer) const;

 private:
  struct Belief {
    float empty = 0;     // E
    float occupied = 0;  // O
    double value() const { return occupied >= empty ? occupied : -empty; }
  };
  struct ArcCell {
    Cell cell{};
    float share = 0;  // q
  };
  template <typename Visit>
  void for_each_in(const RangeSector& sector, Visit&& visit) const;

  RollingGrid<Belief> cells_{kCell, kSide};
  std::vector<ArcCell> arc_{};
  NewPicture is_new_{};
};

/// Plans with A* on the grid five times a second [D] and follows the path. It keeps the hull plus a
/// margin away from occupied cells; unknown cells count as free. For a goal beyond the grid it
/// plans to the border. Without a way the robot drives to the reachable place nearest to the goal.
/// It stands still if it is already too near to an obstacle.
class CertaintyGridPlanner final : public Baseline {
 public:
  static ParameterList parameters();

 private:
  void forget() override;
  void retarget() override { planned_at_.reset(); }
  void steer(const ControlInput& in, const Parameters& parameters, ControlOutput& out) override;
  void tell(const Telemetry& t, Explanation& words) const override;
  void plan(const ControlInput& in, double margin);
  void fill_costs(double hard);
  CostGrid view() const;
  void open_way_out(const Vec2& robot_W);
  GridCell place(Cell c) const;
  Vec2 next_point(const Vec2& p_W, double ahead) const;
  void show_plan(ControlOutput& out) const;

  CertaintyGrid grid_{};
  std::vector<float> costs_{};
  GridSearch search_{};
  std::vector<Vec2> path_W_{};
  bool reaches_ = false;                // the path ends at the goal
  std::optional<double> planned_at_{};  // [s] run clock
};

}  // namespace algo
