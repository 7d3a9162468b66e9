// algo/pipeline/arm_behaviour.hpp: the arm of a robot: brings its hand to a pose or its joints to
// positions, and guards it under every driver.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "algo/arm/known_things.hpp"
#include "algo/arm/reach_task.hpp"
#include "algo/arm/reach_thinker.hpp"
#include "algo/full_strip/scan_points.hpp"
#include "algo/intent.hpp"
#include "algo/pipeline/arm_guard.hpp"
#include "algo/pipeline/mover_watch.hpp"
#include "algo/pipeline/reactive.hpp"

namespace algo {

inline constexpr ParameterInfo kArmSweeps{
    .name = "arm.sweeps",
    .label = "Sweeps of the arm's strip",
    .min = 1,
    .max = 100,
    .step = 1,
    .initial = 20,
    .help = "How often the strip of arm and base is relaxed in one tick."};
inline constexpr ParameterInfo kHandSpeed{
    .name = "arm.hand_speed",
    .label = "Speed of the hand on its path",
    .unit = "m/s",
    .min = 0.01,
    .max = 0.3,
    .step = 0.01,
    .initial = 0.1,
    .help = "How fast the hand goes along the path behind its goal."};
/// The behaviour's parameters.
inline constexpr auto kArmParameters =
    std::to_array<const ParameterInfo*>({&kArmSweeps, &kHandSpeed});

/// Wants the base only for a goal of the hand, or to carry something. Before the behaviour that
/// drives to the base's goals.
class ArmBehaviour final : public Behaviour {
 public:
  static constexpr double kThinkTime = 0.1;  // [s] run clock, at least, until a plan is taken

  /// `spec` has an arm. `declared` are the pieces that the robot knows from the start.
  ArmBehaviour(const RobotSpec& spec,
               std::vector<Obstacle> declared,
               std::unique_ptr<ReachThinker> thinker);

  Name name() const override { return behaviours::kArm; }
  void reset(const Pose2& start_W) override;
  Proposal propose(const Resource& in, ControlOutput& output) override;

  /// Takes edits and TakePlan; ignores other requests.
  void apply(const Request& request);
  /// True if the plan that it waits for has come: the run then requests TakePlan.
  bool plan_ready() const;
  /// `command` as far as no part of the robot comes too near to something; see ArmGuard.
  Command guarded(const Resource& in, const Command& command) const;
  /// The mission of arm and base together, if they have a goal.
  std::optional<Mission> mission() const;
  /// Adds the arm to `t`. After the gate.
  void show(Telemetry& t);
  void explain(const Telemetry& t, Explanation& words) const;

 private:
  struct Drive {
    Twist2 base{};
    JointValues rates{};
  };
  std::optional<Drive> reach(const Resource& in);
  std::optional<Drive> turn(const Resource& in);
  void sense(const Resource& in);
  void look(const Observation& seen);
  void see_move(const Track& track);
  void show_things(Telemetry& t) const;

  RobotSpec spec_;
  MobileArm body_;
  std::vector<Obstacle> declared_;
  std::unique_ptr<ReachThinker> thinker_;
  KnownThings known_{};
  ScanPoints points_{};
  MoverWatch ahead_{};   // of the scanner ahead,
  MoverWatch beside_{};  // and of the first other one
  ArmGuard guard_;
  ReachTask task_;

  // Of the run:
  std::uint32_t goals_ = 0;        // of Intent::arm_goals, the newest taken
  bool begun_ = false;             // the task has the newest hand's goal
  std::optional<double> asked_{};  // [s] when the task's question was asked
  bool take_ = false;              // TakePlan came for this tick
  std::optional<double> shown_{};  // [s] when the plan was last shown
  std::uint32_t shown_plan_ = 0;

  // Of the tick:
  double stamp_ = 0;                 // [s] run clock
  std::optional<BodyJoints> now_{};  // none without a reading of the joints
  std::vector<Solid> unseen_{};      // bodies that have moved out of sight
  std::vector<Solid> near_{};
  std::optional<SetHandGoal> hand_goal_{};
  std::optional<SetGoal> carry_goal_{};
  std::optional<SetJoints> joint_goal_{};
  ArmState state_ = ArmState::Rest;
};

}  // namespace algo
