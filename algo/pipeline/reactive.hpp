// algo/pipeline/reactive.hpp: the reactive layer of the thesis' hybrid architecture: the inputs of
// behaviours, behaviours that propose, a coordinator that picks, and the actuator's limits.
//
// Nong 2008 (thesis) Fig. 22: obstacle avoidance = AvoidBehaviour's controller, determining
// velocity = the controllers' driving law, actuator = actuate().
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "algo/controller.hpp"
#include "algo/intent.hpp"
#include "algo/pipeline/shared_control.hpp"
#include "algo/pipeline/stick_guard.hpp"
#include "algo/sensor_merge.hpp"
#include "algo/telemetry.hpp"

namespace algo {

/// The inputs of every behaviour in one tick. None contains the true pose.
struct Resource : ControlInput {
  const SensorMerge* merge = nullptr;   // recent sonar and infrared returns
  std::span<const Twist2> under_way{};  // commands sent that do not act yet, oldest first
  const Parameters* parameters = nullptr;
  const Intent* intent = nullptr;  // for the arm's goals
  Mission mission = Mission::Idle;
  Joystick joystick{};
  bool manual = false;  // a driver's stick is active
};

/// Bounds that one behaviour sets for the twist of any behaviour, with the reason.
struct TwistLimits {
  double v_min = -std::numeric_limits<double>::infinity();      // [m/s]
  double v_max = std::numeric_limits<double>::infinity();       // [m/s]
  double omega_min = -std::numeric_limits<double>::infinity();  // [rad/s]
  double omega_max = std::numeric_limits<double>::infinity();   // [rad/s]
  Limit reason{};
};

struct Proposal {
  bool active = false;  // wants the base
  Twist2 twist{};
  TwistLimits limits{};                // apply even if the behaviour does not want the base
  Limit limit{};                       // why `twist` is not what its driver wants
  std::optional<JointValues> rates{};  // [rad/s] wants the arm
};

class Behaviour {
 public:
  virtual ~Behaviour() = default;
  /// "avoid", as REST and CSV spell it.
  virtual Name name() const = 0;
  /// [s] Time between samples; the proposal is held in between. 0: every tick.
  virtual double period() const { return 0; }
  virtual void reset(const Pose2& start_W) = 0;
  /// As Controller::move().
  virtual void move(const MapMove& /*move*/, const Pose2& here_W) { reset(here_W); }
  /// `output` is drawn by the page and kept by the record; only AvoidBehaviour fills it.
  virtual Proposal propose(const Resource& resource, ControlOutput& output) = 0;
};

/// Drives to the goal with a controller of the catalogue.
class AvoidBehaviour final : public Behaviour {
 public:
  explicit AvoidBehaviour(std::unique_ptr<Controller> controller)
      : controller_(std::move(controller)) {}
  const Controller& controller() const { return *controller_; }
  void begin(const RunFacts& run) { controller_->begin(run); }
  Name name() const override { return behaviours::kAvoid; }
  void reset(const Pose2& start_W) override { controller_->reset(start_W); }
  void move(const MapMove& move, const Pose2& here_W) override { controller_->move(move, here_W); }
  Proposal propose(const Resource& resource, ControlOutput& output) override;
  /// The motion to a goal that a driver's stick pulls along.
  Twist2 follow(const Resource& in, const SetGoal& pulled, ControlOutput& output);

 private:
  std::unique_ptr<Controller> controller_;
};

/// Whether the stick pulls a goal along: in mode Elastic, and ahead. Controllers do not back up to
/// a goal behind.
bool pulls_goal(const Resource& in);

inline constexpr ParameterInfo kJoystickTimeout{
    .name = "manual.joystick_timeout",
    .label = "Joystick timeout",
    .unit = "s",
    .min = 0.1,
    .max = 2.0,
    .step = 0.1,
    .initial = 0.5,
    .help = "The robot stops when the stick has been silent for this long.",
    .alias = "joystick_timeout"};

/// Follows the driver's stick as far as its mode allows.
class ManualBehaviour final : public Behaviour {
 public:
  /// `avoid` follows the goals that the stick pulls along; it outlives this.
  explicit ManualBehaviour(AvoidBehaviour& avoid) : avoid_(avoid) {}
  Name name() const override { return behaviours::kManual; }
  void reset(const Pose2& start_W) override;
  Proposal propose(const Resource& resource, ControlOutput& output) override;
  /// Adds the explanation of this tick's motion to `t`.
  void show(Telemetry& t) const;

 private:
  Twist2 guarded(const Resource& in, const Twist2& wanted, Limit& limit);
  Twist2 pulled(const Resource& in, const Twist2& full, ControlOutput& output);

  AvoidBehaviour& avoid_;
  StickGuard guard_{};
  OwnRing own_ring_{};
  SharedControl shared_{};          // at rest unless a stick in mode Wall is active
  std::optional<double> course_{};  // [rad] in W, while the stick pulls a goal along
  std::optional<Vec2> pull_W_{};    // this tick's pulled goal
};

struct Decision {
  Name winner = behaviours::kRest;
  Twist2 twist{};
  std::optional<JointValues> rates{};  // [rad/s] of the first behaviour that wants the arm
  Limit limit{};  // the winner's own, or the limit that changed its twist; the last of several
};

/// Samples each behaviour at its own period and takes the first active one in the order given,
/// which is the priority. Applies the limits of all behaviours, inactive ones too.
class BehaviourCoordinator {
 public:
  void add(std::unique_ptr<Behaviour> behaviour) {
    slots_.push_back({.behaviour = std::move(behaviour)});
  }
  void reset(const Pose2& start_W);
  void move(const MapMove& move, const Pose2& here_W);
  Decision decide(const Resource& resource, ControlOutput& output);

 private:
  struct Slot {
    std::unique_ptr<Behaviour> behaviour{};
    Proposal held{};
    double age = std::numeric_limits<double>::infinity();  // [s] since its last sample
  };
  void sample_anew();

  std::vector<Slot> slots_{};
};

/// `twist` within `limits`, each component on its own. Contradictory limits give zero. NaN stays,
/// for the gate.
Twist2 limited(const Twist2& twist, const TwistLimits& limits);

/// The command to the base: `twist` within the robot's own limits.
Command actuate(const Twist2& twist, const RobotSpec& spec);
/// The same with the arm's joints at `rates` [rad/s], within their limits. `joints` is the newest
/// reading, if there is one.
Command actuate(const Decision& decision,
                const std::optional<JointReading>& joints,
                const RobotSpec& spec);

}  // namespace algo
