// algo/baselines/vff.hpp: virtual force field: cells push by their certainty, the goal pulls, and
// the robot steers to the sum (Borenstein and Koren 1989; equations.md F.4).
#pragma once

#include "algo/baselines/baseline.hpp"
#include "algo/baselines/histogram_grid.hpp"

namespace algo {

struct VffForces {
  Vec2 repulsion{0, 0};   // F_r
  Vec2 attraction{0, 0};  // F_t
  Vec2 sum() const { return repulsion + attraction; }
};

/// F_r = - sum F_cr C / (d / cell)^2 (unit vector robot -> cell) over the active window,
/// F_t = F_ct (unit vector robot -> goal). A cell or goal at the robot itself has no direction and
/// gives no force.
VffForces vff_forces(
    const HistogramGrid& grid, const Vec2& robot_W, const Vec2& goal_W, double f_cr, double f_ct);

/// v_max without a push, else v_max (1 - |cos(angle between the velocity and F_r)|). The velocity
/// points along `heading`.
double vff_speed(const Vec2& repulsion_W, double heading, double v_max);

class Vff final : public Baseline {
 public:
  static ParameterList parameters();

 private:
  void forget() override { grid_.clear(); }
  void steer(const ControlInput& in, const Parameters& parameters, ControlOutput& out) override;
  void tell(const Telemetry& t, Explanation& words) const override { tell_pushed(t, words); }

  HistogramGrid grid_{};
};

}  // namespace algo
