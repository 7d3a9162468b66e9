// algo/baselines/dwa.hpp: dynamic window: chooses the twist that best combines heading, clearance
// and speed. Candidates are the twists that the motors can reach and the brakes can stop (Fox,
// Burgard, Thrun 1997).
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "algo/baselines/baseline.hpp"
#include "algo/hull.hpp"

namespace algo {

/// The free travel along the arc of a constant twist before the hull touches a point.
struct ArcRoom {
  double distance = std::numeric_limits<double>::infinity();  // [m] travelled by the centre
  double angle = std::numeric_limits<double>::infinity();     // [rad] turned
};

/// The room of `twist` (v >= 0) before `point_R`. Infinite if the hull never touches the point,
/// zero if the point is inside the hull.
ArcRoom arc_room(const Hull& hull, const Twist2& twist, const Vec2& point_R);

/// The least room before any of `points_R`.
ArcRoom arc_room(const Hull& hull, const Twist2& twist, std::span<const Vec2> points_R);

/// v_a: true if the robot can still stop within the room: v^2 <= 2 a distance and
/// w^2 <= 2 alpha angle, after moving on for `reaction` [s].
bool admissible(const Twist2& twist, const ArcRoom& room, const RobotSpec& spec, double reaction);

/// v_d: the twists within the limits that the robot can reach in one interval.
struct DynamicWindow {
  double v_from = 0;
  double v_to = 0;
  double omega_from = 0;
  double omega_to = 0;
};
DynamicWindow dynamic_window(const Twist2& now,
                             const RobotSpec& spec,
                             const Parameters& parameters);

/// Weights of heading, room and speed in the objective.
struct DwaWeights {
  double heading = 0;
  double room = 0;
  double speed = 0;
};

/// G = heading + dist + velocity, each of 0..1 times its weight (0.4, 0.4, 0.2 [D]).
/// heading = 1 - |angle to the goal| / pi, at the pose after one interval of the twist and then
/// braking the turn. dist is the room, 1 from 3 m on [D]. velocity = v / v_max. The paper smooths
/// the sum over the window; this code does not. With most of the weight on the heading, the robot
/// stops facing a post on its line.
double dwa_objective(const Pose2& pose_W,
                     const Vec2& goal_W,
                     const Twist2& twist,
                     const ArcRoom& room,
                     double v_max,
                     const RobotSpec& spec,
                     const DwaWeights& weights);

class Dwa final : public Baseline {
 public:
  static ParameterList parameters();

 private:
  void forget() override;
  void steer(const ControlInput& in, const Parameters& parameters, ControlOutput& out) override;
  void tell(const Telemetry& t, Explanation& words) const override;
  void gather(const ControlInput& in, double reach);

  // The nearest return in every two degrees of bearing, in R.
  std::vector<Vec2> points_R_{};
};

}  // namespace algo
