// algo/controller.hpp: what turns a scene and a goal into a twist, and the table of all that can.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

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
};

/// The block "obstacle avoidance" and "determining velocity" of the thesis (Fig. 22).
class Controller {
 public:
  virtual ~Controller() = default;

  /// Forgets everything of the run before.
  virtual void reset(const Pose2& start_W) = 0;

  /// One tick. Overwrites every field of `out`. No goal: twist zero, strip empty. Reads
  /// `parameters` anew each tick. Any input that is not finite gives twist zero and an empty strip
  /// (NaN never reaches a comparison).
  virtual void update(const ControlInput& in, const Parameters& parameters, ControlOutput& out) = 0;
};

struct ControllerInfo {
  std::string_view name{};   // "modified": REST, command line, scenario files
  std::string_view label{};  // for people
  std::string_view help{};
  bool by_sonar = false;  // drives a robot that has a sonar ring and no laser
};

std::span<const ControllerInfo> controller_table();

/// Why the controller `name` cannot run with `parameters`, as a sentence; nothing when it can.
std::optional<std::string> refusal(std::string_view name, const Parameters& parameters);

/// Throws std::invalid_argument naming the known ones.
std::unique_ptr<Controller> make_controller(std::string_view name);

}  // namespace algo
