// algo/controller.hpp: what turns a scene and a goal into a twist.
#pragma once

#include <optional>

#include "algo/observation.hpp"
#include "algo/parameters.hpp"
#include "algo/request.hpp"
#include "algo/robot.hpp"
#include "algo/telemetry.hpp"
#include "algo/types.hpp"

namespace algo {

struct ControlInput {
  double stamp = 0;  // [s] run clock
  double dt = 0;     // [s] tick
  Odometry odometry{};
  const Scene* scene = nullptr;              // never null in update(), as are the other two
  const Observation* observation = nullptr;  // for what the scene leaves out: sonar, other scanners
  std::optional<SetGoal> goal{};
  const RobotSpec* spec = nullptr;  // hull, limits, delay
  /// Whether somebody wants to see grids in this tick, which are large. Never changes a command.
  bool grids = false;
};

/// The block "obstacle avoidance" and "determining velocity" of the thesis (Fig. 22).
class Controller {
 public:
  virtual ~Controller() = default;

  /// Forgets everything of the run before.
  virtual void reset(const Pose2& start_W) = 0;

  /// One tick. Overwrites every field of `out`. No goal: twist zero and nothing shown. Reads
  /// `parameters` anew each tick. Any input that is not finite gives twist zero and nothing shown
  /// (NaN never reaches a comparison).
  virtual void update(const ControlInput& in, const Parameters& parameters, ControlOutput& out) = 0;

  /// What the tick `t` was about, while it drives to t.goal: one of this controller's. Fills
  /// `words`, which are empty. Not asked every tick.
  virtual void explain(const Telemetry& t, Explanation& words) const = 0;
};

}  // namespace algo
