// algo/controller.hpp: the interface that turns a scene and a goal into a twist.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "algo/drawn_space.hpp"
#include "algo/map_move.hpp"
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
  const Scene* scene = nullptr;              // never null in update(), nor are the other two
  const Observation* observation = nullptr;  // for sensors outside the scene: sonar, other scanners
  std::optional<SetGoal> goal{};
  const RobotSpec* spec = nullptr;  // hull, limits, delay
  /// True if a viewer wants grids in this tick; grids are large. Never changes a command.
  bool grids = false;
  /// True if another behaviour has driven since the last call: the answer to it had no effect.
  bool interrupted = false;
};

/// The run that a controller drives.
struct RunFacts {
  std::string scenario{};
  std::uint64_t seed = 1;
  std::stop_token stop{};  // ends the run, and the waits of its controller
  /// The map that the robot drives by; null: none.
  std::shared_ptr<const DrawnSpace> map{};
};

/// The blocks "obstacle avoidance" and "determining velocity" of the thesis (Fig. 22).
class Controller {
 public:
  virtual ~Controller() = default;

  /// Called once, before the first reset(). Most controllers need not know their run.
  virtual void begin(const RunFacts& /*run*/) {}
  /// Forgets the previous run.
  virtual void reset(const Pose2& start_W) = 0;

  /// The map of the robot's surroundings moved, and the robot, now at `here_W`, with it: what is
  /// remembered of W lies elsewhere. A controller that does not know how to move it forgets it.
  virtual void move(const MapMove& /*move*/, const Pose2& here_W) { reset(here_W); }

  /// Computes one tick. Overwrites every field of `out`. Reads `parameters` anew each tick. Without
  /// a goal, or if any input is not finite, the twist is zero and nothing is shown (NaN never
  /// reaches a comparison).
  virtual void update(const ControlInput& in, const Parameters& parameters, ControlOutput& out) = 0;

  /// Explains the tick `t`, in which this controller drives to t.goal. `words` is empty on entry.
  /// Not called every tick.
  virtual void explain(const Telemetry& t, Explanation& words) const = 0;
};

}  // namespace algo
