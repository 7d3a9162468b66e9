// algo/baselines/go_to_goal.cpp: one tick of go-to-goal.
#include "algo/baselines/go_to_goal.hpp"

namespace algo {

void GoToGoal::steer(const ControlInput& in, const Parameters& parameters, ControlOutput& out) {
  out.state = 1;
  const double bearing = bearing_W(in.odometry.pose.position(), goal_W(in));
  steer_along(in, bearing, parameters[kMaxSpeed], parameters, out);
}

void GoToGoal::tell(const Telemetry& t, Explanation& words) const {
  say_driving(t, words);
  words.what = "Driving straight to the goal";
}

}  // namespace algo
