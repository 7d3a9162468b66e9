// algo/pipeline/pipeline.hpp: one tick, sense to command: plain data, no clock, file, socket or
// chance.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "algo/intent.hpp"
#include "algo/pipeline/controllers.hpp"
#include "algo/pipeline/grid_thinning.hpp"
#include "algo/pipeline/narrator.hpp"
#include "algo/pipeline/reactive.hpp"
#include "algo/pipeline/sensing.hpp"
#include "algo/pipeline/sequencing.hpp"
#include "algo/telemetry.hpp"

namespace algo {

struct PipelineConfig {
  std::string controller = "modified";
  FilterKind filter = FilterKind::Pseudomedian;
  Parameters parameters{};
  /// A person may take the stick. A robot that nobody can reach needs no map for that.
  bool by_hand = true;
};

/// Everything that turns observations and requests into commands for one robot. Fed the same
/// observations and requests again, a fresh one gives the same commands bit for bit.
class Pipeline {
 public:
  /// Throws std::invalid_argument on an unknown controller.
  Pipeline(const PipelineConfig& config,
           const RobotSpec& spec,
           const ControllerCatalogue& controllers = builtin_controllers());

  /// Starts over with the robot at rest at `start_W`.
  void reset(const Pose2& start_W);

  /// Why `request` cannot be applied now, as a sentence. Obstacle edits are the robot's business.
  std::optional<std::string> refusal(const Request& request) const;
  /// The same of a parameter, when the others are as in `now`: some accepted before it may be on
  /// their way still.
  std::optional<std::string> refusal(const Parameters& now, const SetParameter& set) const;

  /// Fills the rest of `t`, whose observation and requests are given. Allocates nothing once its
  /// buffers have grown.
  void tick(Telemetry& t);

  /// Whether grids are made for people to see, at most twice a second. Never changes a command.
  void want_grids(bool wanted) { grids_wanted_ = wanted; }

  const Parameters& parameters() const { return intent_.parameters; }
  /// Of all requests but obstacle edits, up to the newest tick.
  const Intent& intent() const { return intent_; }

 private:
  void apply(const Request& request);
  void sense(Telemetry& t);
  void sense_sonar(Telemetry& t);
  void control(Telemetry& t);
  void hold(Telemetry& t);
  void remember(const Twist2& command);
  void show_nearest(Telemetry& t) const;

  RobotSpec spec_{};
  bool by_hand_ = true;
  ControllerInfo controller_{};
  Parameters initial_parameters_{};
  Intent intent_{};  // but for the obstacles, which are the robot's
  Sensing sensing_;
  BehaviourCoordinator coordinator_{};
  const Controller* avoiding_ = nullptr;  // one of its behaviours'
  Sequencer sequencer_{};
  Scene scene_{};
  bool by_sonar_ = false;               // the ring stands in for the scanner
  std::optional<double> scan_stamp_{};  // or of the newest sonar reading, when by_sonar_
  bool blinded_ = false;                // the newest scan is
  double clearance_ = 0;                // [m] of the newest scan
  std::uint64_t joystick_ticks_ = 0;    // ticks the stick's value still counts
  std::vector<Twist2> under_way_{};     // commands given that do not act yet, oldest first
  GridThinning grids_{};
  bool grids_wanted_ = false;
  Narrator narrator_{};
  std::uint64_t tick_ = 0;
};

}  // namespace algo
