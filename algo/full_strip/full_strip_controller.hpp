// algo/full_strip/full_strip_controller.hpp: `strip`, the full elastic strip. It has a planner on
// the map of the scans (deliberative), a strip of many nodes (reactive), phases and recoveries
// (sequencing), and a velocity stage that proves every command.
#pragma once

#include <memory>

#include "algo/controller.hpp"
#include "algo/drawn_space.hpp"
#include "algo/full_strip/commands_under_way.hpp"
#include "algo/full_strip/full_strip_parameters.hpp"
#include "algo/full_strip/giving_way.hpp"
#include "algo/full_strip/narrow_place.hpp"
#include "algo/full_strip/progress_watch.hpp"
#include "algo/full_strip/recovery.hpp"
#include "algo/full_strip/strip_route.hpp"
#include "algo/full_strip/strip_senses.hpp"
#include "algo/full_strip/strip_state.hpp"
#include "algo/full_strip/velocity_stage.hpp"
#include "algo/full_strip/weighing.hpp"

namespace algo {

class FullStripController final : public Controller {
 public:
  static ParameterList parameters();

  /// `among_moving`: tracks moving obstacles, and gives way to them by the beam search.
  explicit FullStripController(bool among_moving = false) : among_moving_(among_moving) {}

  void begin(const RunFacts& run) override;
  void reset(const Pose2& start_W) override;
  void move(const MapMove& move, const Pose2& here_W) override;
  void update(const ControlInput& in, const Parameters& parameters, ControlOutput& out) override;
  void explain(const Telemetry& t, Explanation& words) const override;

  /// Map and memory, for studies.
  const StripSenses& senses() const { return senses_; }

  using State = strip_state::State;
  using enum strip_state::State;

 private:
  void forget_attempts(const ControlInput& in);
  void prepare(const ControlInput& in, const Parameters& parameters);
  void take_goal(const ControlInput& in);
  RouteSettings route_settings(const Parameters& parameters) const;
  StripCommand drive(const StageInput& stage, const ControlInput& in, const Parameters& parameters);
  Twist2 gentle(const StageInput& stage, const StripCommand& command);
  StageInput stage_input(const ControlInput& in) const;
  Twist2 watch(const ControlInput& in, const Parameters& parameters) const;
  bool ends_here(const ControlInput& in, const Parameters& parameters) const;
  void watch_progress(const ControlInput& in);
  std::optional<StripCommand> carry_on(const StageInput& stage, const ControlInput& in);
  std::optional<StripCommand> follow(const StageInput& stage, const ControlInput& in);
  StripCommand recover(const StageInput& stage, const ControlInput& in);
  void report(const ControlInput& in, ControlOutput& out) const;
  PlanWorld plan_world() const { return {senses_.map(), senses_.memory(), drawn_.get()}; }
  void tell_map(ControlOutput& out) const;
  void show_strip(ControlOutput& out) const;
  void show_moving(ControlOutput& out) const;
  void show_weighed(ControlOutput& out) const;

  bool among_moving_ = false;
  std::shared_ptr<const DrawnSpace> drawn_{};  // null: no map is known
  MotionLimits limits_{};
  StripSenses senses_{};
  StripRoute route_{};
  VelocityStage stage_{};
  NarrowPlace narrow_place_{};
  GivingWay giving_way_{};
  Recovery recovery_{};
  ProgressWatch progress_{};
  CommandsUnderWay under_way_{};
  CommandCourse course_{};
  bool hard_ = false;  // the last command exceeds the robot's jerk
  State state_ = kNone;
  Weighing weighed_{};  // of this tick
};

}  // namespace algo
