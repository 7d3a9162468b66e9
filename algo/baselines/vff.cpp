// algo/baselines/vff.cpp: the forces, the speed, and one tick.
#include "algo/baselines/vff.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace algo {
namespace {

// [D] A post of six certain cells face-on balances the goal at sqrt(6 15 F_cr / F_ct) = 6.7 cells.
constexpr ParameterInfo kRepulsion{.name = "vff.repulsion",
                                   .label = "Repulsion F_cr",
                                   .max = 5,
                                   .step = 0.05,
                                   .initial = 0.5,
                                   .help = "How strongly each certain cell pushes."};
constexpr ParameterInfo kAttraction{.name = "vff.attraction",
                                    .label = "Attraction F_ct",
                                    .min = 0.1,
                                    .max = 5,
                                    .step = 0.05,
                                    .initial = 1.0,
                                    .help = "How strongly the goal pulls."};
constexpr auto kVffParameters = std::to_array<const ParameterInfo*>(
    {&kRepulsion, &kAttraction, &kMaxSpeed, &kMaxTurnRate, &kHeadingGain, &kGoalReach});
// [D] The least share of v_max. Under the faintest push from straight ahead, the law would stand
// still for ever, since nothing else then changes.
constexpr double kCreep = 0.1;

}  // namespace

ParameterList Vff::parameters() {
  return kVffParameters;
}

VffForces vff_forces(
    const HistogramGrid& grid, const Vec2& robot_W, const Vec2& goal_W, double f_cr, double f_ct) {
  VffForces forces;
  grid.for_each_in_window(robot_W, [&](const Vec2& offset, double c) {
    const double d = offset.norm();
    if (!(d > 0)) return;
    const double in_cells = d / HistogramGrid::kCell;
    forces.repulsion -= f_cr * c / (in_cells * in_cells) * offset / d;
  });
  const Vec2 way = goal_W - robot_W;
  const double to_goal = way.norm();
  if (to_goal > 0) forces.attraction = f_ct * way / to_goal;
  return forces;
}

double vff_speed(const Vec2& repulsion_W, double heading, double v_max) {
  const double size = repulsion_W.norm();
  if (!(size > 0)) return v_max;
  const double along = direction(heading).dot(repulsion_W) / size;
  return v_max * std::max(0.0, 1 - std::abs(along));
}

void Vff::steer(const ControlInput& in, const Parameters& parameters, ControlOutput& out) {
  out.state = 1;
  grid_.sense(in);
  grid_.show(in, out);
  const Pose2& pose = in.odometry.pose;
  const VffForces forces = vff_forces(
      grid_, pose.position(), goal_W(in), parameters[kRepulsion], parameters[kAttraction]);
  const Vec2 sum = forces.sum();
  if (!(sum.norm() > 0)) return;  // pull and pushes cancel: no direction
  const double v_max = parameters[kMaxSpeed];
  const double speed = std::max(kCreep * v_max, vff_speed(forces.repulsion, pose.heading, v_max));
  steer_along(in, std::atan2(sum.y(), sum.x()), speed, parameters, out);
}

}  // namespace algo
