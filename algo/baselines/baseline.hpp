// algo/baselines/baseline.hpp: what the comparison controllers share: when to rest, when to turn to
// the goal's heading, and which returns they see.
//
// The comparison controllers are those the thesis names in its section 1.1, and one that drives
// straight at the goal. They see the filtered front scan (the sonar ring where there is no
// scanner) and the odometry, never the truth; their laws are those of equations.md F, "from the
// general literature as commonly stated", with the constants marked [D] ours.
#pragma once

#include <optional>

#include "algo/controller.hpp"
#include "algo/driving.hpp"
#include "algo/explain.hpp"

namespace algo {

class Baseline : public Controller {
 public:
  void reset(const Pose2& start_W) final;
  /// Rests without a goal, on numbers that are not finite and on an obstacle point; within
  /// goal_reach turns to the goal's heading; steer() otherwise.
  void update(const ControlInput& in, const Parameters& parameters, ControlOutput& out) final;
  /// "Driving to the goal" while the robot turns at it; tell() else.
  void explain(const Telemetry& t, Explanation& words) const final;

 private:
  /// Forgets everything of the run before; a run ends with its goal.
  virtual void forget() = 0;
  /// The goal has moved; what was learnt of the world still holds.
  virtual void retarget() {}
  /// Fills `out`, which is clear, for a robot that has not arrived. Its state is 1 or more then.
  virtual void steer(const ControlInput& in, const Parameters& parameters, ControlOutput& out) = 0;
  /// The words of a tick that steer() filled.
  virtual void tell(const Telemetry& t, Explanation& words) const = 0;

  std::optional<Vec2> goal_W_{};  // of the tick before
};

/// What steer() may rely on.
inline const Vec2& goal_W(const ControlInput& in) {
  return in.goal->position_W;
}

/// [rad] bearing of `to` seen from `from`, in W.
double bearing_W(const Vec2& from_W, const Vec2& to_W);

/// The words of those that follow the sum of a pull and pushes.
void tell_pushed(const Telemetry& t, Explanation& words);

/// Sends the base along `bearing` in W: the twist, and a pass point for the page.
void steer_along(const ControlInput& in,
                 double bearing,
                 double speed,
                 const Parameters& parameters,
                 ControlOutput& out);

}  // namespace algo
