// algo/full_strip/full_strip_controller.hpp: `strip`, the full elastic strip. It has a planner on
// the map of the scans (deliberative), a strip of many nodes (reactive), phases and recoveries
// (sequencing), and a velocity stage that proves every command.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "algo/controller.hpp"
#include "algo/full_strip/local_map.hpp"
#include "algo/full_strip/maneuver.hpp"
#include "algo/full_strip/motion.hpp"
#include "algo/full_strip/node_strip.hpp"
#include "algo/full_strip/planner.hpp"
#include "algo/full_strip/scan_points.hpp"
#include "algo/full_strip/space_time.hpp"
#include "algo/full_strip/tracker.hpp"
#include "algo/full_strip/velocity_stage.hpp"
#include "algo/full_strip/weighing.hpp"

namespace algo {

inline constexpr ParameterInfo kNearestGoal{
    .name = "full_strip.nearest_goal",
    .label = "Goal taken: go near",
    .unit = "",
    .min = 0.0,
    .max = 1.0,
    .step = 1.0,
    .initial = 1.0,
    .help =
        "What the full strip does when something stands on its goal: 1 drives to the nearest "
        "free place, 0 stops where it finds out.",
    .alias = "nearest_goal"};

class FullStripController final : public Controller {
 public:
  static ParameterList parameters();

  /// `among_moving`: tracks moving obstacles, and gives way to them by the beam search.
  explicit FullStripController(bool among_moving = false) : among_moving_(among_moving) {}

  void reset(const Pose2& start_W) override;
  void update(const ControlInput& in, const Parameters& parameters, ControlOutput& out) override;
  void explain(const Telemetry& t, Explanation& words) const override;

  /// The state that its words explain: ControlOutput::state.
  using State = std::uint8_t;
  static constexpr std::uint8_t kNone = 0;
  static constexpr std::uint8_t kFollowing = 1;    // along the strip
  static constexpr std::uint8_t kTurning = 2;      // on the spot, towards the strip
  static constexpr std::uint8_t kManeuvering = 3;  // to and fro in a narrow place
  static constexpr std::uint8_t kGivingWay = 4;    // to moving obstacles
  static constexpr std::uint8_t kCornered = 5;     // every motion would meet a moving obstacle
  static constexpr std::uint8_t kEscaping = 6;     // out of a place that is too narrow
  static constexpr std::uint8_t kBackingOff = 7;   // after a long blockage
  static constexpr std::uint8_t kNoWay = 8;        // the map has no path to the goal
  static constexpr std::uint8_t kBlocked = 9;      // no motion is free at present
  static constexpr std::uint8_t kGoalTaken = 10;   // an obstacle stands on the goal; drives no
                                                   // farther

 private:
  void forget_way();
  void forget_attempts(const ControlInput& in);
  void prepare(const ControlInput& in, const Parameters& parameters);
  void sense(const ControlInput& in);
  void forget_traces(const ControlInput& in);
  void ease_last_leg(const Vec2& here_W);
  void plan(const ControlInput& in);
  void take_plan(const ControlInput& in);
  void stretch(const ControlInput& in);
  Twist2 drive(const ControlInput& in, const Parameters& parameters);
  void look_for_maneuver(const ControlInput& in);
  std::optional<Twist2> carry_on(const StageInput& stage, const ControlInput& in);
  std::optional<Twist2> give_way(const StageInput& stage, const ControlInput& in);
  Twist2 recover(const StageInput& stage, const ControlInput& in);
  MotionState when_acting(const ControlInput& in) const;
  void remember(const Twist2& command);
  double time_for(double patience) const;
  void watch_progress(const ControlInput& in);
  double least_clearance() const;
  double left(const NodeStrip& strip) const;
  bool ends_here(const ControlInput& in, const Parameters& parameters) const;
  void report(const ControlInput& in, ControlOutput& out) const;
  void show_strip(ControlOutput& out) const;
  void show_moving(ControlOutput& out) const;
  void show_weighed(ControlOutput& out) const;

  bool among_moving_ = false;
  bool placed_ = false;  // the start pose is entered into the map
  ScanPoints points_{};
  LocalMap map_{};
  Tracker tracker_{};
  SpaceTimeSearch space_time_{};
  Planner planner_{};
  NodeStrip strip_{};
  NodeStrip candidate_{};
  VelocityStage stage_{};
  ManeuverSearch search_{};
  ManeuverDrive maneuver_{};
  double next_search_ = 0;  // [s] run clock
  Vec2 way_W_{0, 0};        // last place of progress, turning not counted
  double way_since_ = 0;    // [s]
  StripSettings settings_{};
  MotionLimits limits_{};
  double break_room_ = 0;   // [m] the strip's clearance may fall this far below the planned
  double plan_period_ = 0;  // [s]

  std::optional<Vec2> goal_W_{};
  std::size_t level_ = 0;  // of the planner's clearance; 0 is the widest
  bool no_way_ = false;    // not even at the narrowest clearance
  bool goal_taken_ = false;
  std::optional<double> tight_since_{};  // [s] since when it tries for a goal without room
  double broken_at_ = -1;                // [m] along the strip; negative: whole
  double next_plan_ = 0;                 // [s] run clock
  State state_ = kNone;
  Weighing weighed_{};        // of this tick
  Vec2 progress_W_{0, 0};     // last place of progress
  double progress_at_ = 0;    // [s]
  double back_until_ = -1;    // [s]
  Twist2 escape_{};           // the present escape
  double escape_until_ = -1;  // [s]

  std::vector<Twist2> under_way_{};  // commands sent that do not act yet, oldest first
  Recycled<Vec2> path_W_{};          // the planner's latest path
};

}  // namespace algo
