// algo/baselines/potential_field.hpp: the goal pulls, every near obstacle pushes, and the robot
// follows the sum (Khatib 1986).
#pragma once

#include <vector>

#include "algo/baselines/baseline.hpp"

namespace algo {

/// All are [D], since the papers leave them open. With the parameters' initial values, a robot of
/// radius 0.35 m comes to rest 0.64 m (centre to surface) before a single post on its line.
struct PotentialSettings {
  double k_a = 0;    // [1/m]; forces have no unit
  double f_max = 1;  // largest pull; infinite: no limit
  double eta = 0;    // [m2]
  double rho_0 = 0;  // [m] obstacles beyond it do not push
};

/// F_att = -k_a (p - goal), with its length limited to f_max.
Vec2 attraction(const PotentialSettings& settings, const Vec2& p_W, const Vec2& goal_W);

/// F_rep = eta (1/rho - 1/rho_0) / rho^2 grad rho for 0 < rho <= rho_0, else 0.
/// rho = |p - obstacle|, but at least 0.05 m. Source: Khatib 1986 (equations.md F.3).
Vec2 repulsion(const PotentialSettings& settings, const Vec2& p_W, const Vec2& obstacle_W);

/// A run of beams without a jump of more than 0.3 m between neighbours is one obstacle, which
/// pushes from its nearest point. Otherwise a wall of a hundred beams would push like a hundred
/// posts. Each sonar reading is an obstacle.
class PotentialField final : public Baseline {
 public:
  static ParameterList parameters();

 private:
  void forget() override;
  void steer(const ControlInput& in, const Parameters& parameters, ControlOutput& out) override;
  void tell(const Telemetry& t, Explanation& words) const override { tell_pushed(t, words); }

  std::vector<Vec2> obstacles_W_{};
};

/// The point of each obstacle nearest to the robot, as above.
void nearest_points(const ControlInput& in, std::vector<Vec2>& points_W);

}  // namespace algo
