// algo/baselines/baseline.hpp: code that the baseline controllers share: when to rest, when to turn
// to the goal's heading, and which returns to read.
//
// The baselines are the controllers that the thesis names in its section 1.1, and one that drives
// straight at the goal. They read the filtered front scan (the sonar ring if there is no scanner)
// and the odometry, never the truth. Their laws are those of equations.md F, "from the general
// literature as commonly stated"; the constants marked [D] are ours.
#pragma once

#include <optional>

#include "algo/controller.hpp"
#include "algo/driving.hpp"
#include "algo/explain.hpp"

namespace algo {

class Baseline : public Controller {
 public:
  void reset(const Pose2& start_W) final;
  /// Rests without a goal, if an input is not finite, and on an obstacle point. Within goal_reach
  /// it turns to the goal's heading; otherwise it calls steer().
  void update(const ControlInput& in, const Parameters& parameters, ControlOutput& out) final;
  /// "Driving to the goal" while the robot turns at the goal; otherwise calls tell().
  void explain(const Telemetry& t, Explanation& words) const final;

 private:
  /// Forgets the previous run; a run ends with its goal.
  virtual void forget() = 0;
  /// The goal has moved. Knowledge of the world is still valid.
  virtual void retarget() {}
  /// Fills `out`, which is empty on entry, for a robot that has not arrived. Sets a state of 1 or
  /// more.
  virtual void steer(const ControlInput& in, const Parameters& parameters, ControlOutput& out) = 0;
  /// Explains a tick that steer() filled.
  virtual void tell(const Telemetry& t, Explanation& words) const = 0;

  std::optional<Vec2> goal_W_{};  // of the previous tick
};

/// The goal's position; steer() may rely on it.
inline const Vec2& goal_W(const ControlInput& in) {
  return in.goal->position_W;
}

/// [rad] Bearing in W from `from` to `to`.
double bearing_W(const Vec2& from_W, const Vec2& to_W);

/// Words for the controllers that follow the sum of a pull and pushes.
void tell_pushed(const Telemetry& t, Explanation& words);

/// Drives the base along `bearing` in W: sets the twist, and a pass point for the page.
void steer_along(const ControlInput& in,
                 double bearing,
                 double speed,
                 const Parameters& parameters,
                 ControlOutput& out);

}  // namespace algo
