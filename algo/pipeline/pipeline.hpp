// algo/pipeline/pipeline.hpp: one tick, from sensing to command: plain data, without clock, file,
// socket or randomness.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "algo/arm/reach_thinker.hpp"
#include "algo/intent.hpp"
#include "algo/pipeline/arm_behaviour.hpp"
#include "algo/pipeline/controllers.hpp"
#include "algo/pipeline/grid_thinning.hpp"
#include "algo/pipeline/ground_behaviour.hpp"
#include "algo/pipeline/narrator.hpp"
#include "algo/pipeline/reactive.hpp"
#include "algo/pipeline/sensing.hpp"
#include "algo/pipeline/sequencing.hpp"
#include "algo/pipeline/turnover_guard.hpp"
#include "algo/telemetry.hpp"

namespace algo {

struct PipelineConfig {
  std::string controller = "modified";
  FilterKind filter = FilterKind::Pseudomedian;
  Parameters parameters{};
  /// A person may take the stick. If false, the pipeline keeps no map for that.
  bool by_hand = true;
  RunFacts run{};
  /// Pieces that a robot with an arm knows from the start.
  std::vector<Obstacle> declared{};
  MakeThinker thinker{};  // of a robot with an arm
};

/// Turns observations and requests into commands for one robot. A fresh pipeline with the same
/// observations and requests gives the same commands bit for bit.
class Pipeline {
 public:
  /// Throws std::invalid_argument on an unknown controller.
  Pipeline(const PipelineConfig& config,
           const RobotSpec& spec,
           const ControllerCatalogue& controllers = builtin_controllers());

  /// Starts over with the robot at rest at `start_W`.
  void reset(const Pose2& start_W);

  /// Why `request` cannot be applied now, as a sentence. The robot checks obstacle edits.
  std::optional<std::string> refusal(const Request& request) const;
  /// The same for a parameter, with the others as in `now`, which may hold accepted values that are
  /// not applied yet.
  std::optional<std::string> refusal(const Parameters& now, const SetParameter& set) const;

  /// Fills the rest of `t` from its observation and requests. Does not allocate once its buffers
  /// have grown.
  void tick(Telemetry& t);
  /// The first half of tick(): all that comes before the behaviours propose. `t` then has the
  /// scene, the goal and the mission.
  void look(Telemetry& t);
  /// The second half, for the same `t`.
  void decide(Telemetry& t);

  /// True if a plan has come that the robot asked for. Give it TakePlan before the next tick.
  bool plan_ready() const { return arm_ != nullptr && arm_->plan_ready(); }

  /// Turns grids for display on or off, at most two a second. Never changes a command.
  void want_grids(bool wanted) { grids_wanted_ = wanted; }

  const Parameters& parameters() const { return intent_.parameters; }
  /// The sum of all requests except obstacle edits, up to the newest tick.
  const Intent& intent() const { return intent_; }

 private:
  std::optional<std::string> refusal_of(const SetGoal& goal) const;
  std::optional<std::string> refusal_of(const SetGoals& list) const;
  std::optional<std::string> refusal_of(const SetJoints& joints) const;
  std::optional<std::string> refusal_of(const SetHandGoal& hand) const;
  void apply(const Request& request);
  void notice_ramp(const Request& edit);
  void notice_jump(const Observation& observation);
  void sense(Telemetry& t);
  void sense_sonar(Telemetry& t);
  void sequence(Telemetry& t);
  void control(Telemetry& t);
  void hold(Telemetry& t);
  void remember(const Twist2& command);
  void show_nearest(Telemetry& t) const;

  RobotSpec spec_{};
  bool by_hand_ = true;
  ControllerInfo controller_{};
  Parameters initial_parameters_{};
  Intent intent_{};  // without the obstacles, which belong to the robot
  Sensing sensing_;
  BehaviourCoordinator coordinator_{};
  const ManualBehaviour* manual_ =
      nullptr;                            // one of its behaviours, if a person may take the stick
  TurnoverGuard* turnover_ = nullptr;     // another one, if the robot may turn over
  GroundBehaviour* ground_ = nullptr;     // one of its behaviours, if the robot has floor sensors
  ArmBehaviour* arm_ = nullptr;           // one of its behaviours, if the robot has an arm
  const Controller* avoiding_ = nullptr;  // the controller of one of its behaviours
  Sequencer sequencer_{};
  Scene scene_{};
  bool by_sonar_ = false;               // the sonar ring replaces the scanner
  std::optional<double> scan_stamp_{};  // or of the newest sonar reading, if by_sonar_
  bool blinded_ = false;                // the newest scan is blinded
  std::optional<double> tilt_stamp_{};  // of the inclinometer's newest reading
  double clearance_ = 0;                // [m] of the newest scan
  std::optional<MapPose> map_pose_{};   // the newest, of a robot that knows a map
  std::uint64_t joystick_ticks_ = 0;    // ticks for which the stick's value remains valid
  Name driver_ = behaviours::kRest;     // the behaviour that drove in the tick before
  std::vector<Twist2> under_way_{};     // commands sent that do not act yet, oldest first
  GridThinning grids_{};
  bool grids_wanted_ = false;
  Narrator narrator_{};
  bool by_ramps_ = false;  // there are ramps or trenches, and no sensor looks at the ground
  std::uint64_t tick_ = 0;
};

}  // namespace algo
