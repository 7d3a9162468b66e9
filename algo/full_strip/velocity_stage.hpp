// algo/full_strip/velocity_stage.hpp: the command of one tick, proven before it is given.
#pragma once

#include <optional>

#include "algo/full_strip/motion.hpp"
#include "algo/full_strip/node_strip.hpp"
#include "algo/full_strip/weighing.hpp"

namespace algo {

/// What a stage knows of the tick.
struct StageInput {
  const LocalMap* map = nullptr;
  const NodeStrip* strip = nullptr;
  MotionState state{};  // when the new command will begin to act
  MotionLimits limits{};
  double dt = 0;        // [s]
  double stop_at = -1;  // [m] along the strip where it ends for now; negative: at the goal
};

/// Drives along the strip by pure pursuit. A command is admissible when the robot, following the
/// strip for kHorizon and then braking to rest, keeps kMargin of room all the way and backs into
/// nothing that nobody has seen: the next tick then has an admissible command too, the rest of that
/// same motion. It must do so as well when it is braked after the one tick, as that is what happens
/// when the strip changes or somebody presses Stop.
class VelocityStage {
 public:
  static constexpr double kHorizon = 1.0;  // [s]
  static constexpr double kMargin = 0.03;  // [m] the scanner itself may be off by half of it
  static constexpr double kEscape = 0.6;   // [s]

  void set_hull(const HullCheck& hull) { hull_ = hull; }
  const HullCheck& hull() const { return hull_; }

  /// The fastest admissible command along the strip, nothing when there is none. Notes in `out`
  /// what was weighed and where the robot is sent.
  std::optional<Twist2> follow(const StageInput& in, Weighing& out);

  /// `wanted` when the robot can still be braked to rest after a tick of it.
  std::optional<Twist2> proven(const StageInput& in, const Twist2& wanted, Weighing& out) const;

  /// A way out of too narrow a place, to be held for kEscape: the primitive whose clearance grows
  /// most and never falls.
  std::optional<Twist2> escape(const StageInput& in, Weighing& out) const;
  /// Whether an escape under way may be held for `horizon` [s] more.
  bool still_escapes(const StageInput& in,
                     const Twist2& twist,
                     double horizon,
                     Weighing& out) const;
  /// Straight back, as far as it is free.
  std::optional<Twist2> back_off(const StageInput& in, Weighing& out) const;

 private:
  static constexpr std::size_t kProfile = 28;  // nodes of the speed profile: 4 m
  void profile(const StageInput& in);
  double speed_at(double s) const;
  Twist2 pursue(const StageInput& in, const MotionState& state, double s, double share) const;
  bool admissible(const StageInput& in, double share, Twist2& first, Vec2& aim_W) const;
  bool holds(const StageInput& in, const Twist2& twist, double horizon, double& gain) const;

  HullCheck hull_{};
  std::array<double, kProfile> speed_{};  // [m/s] at each kSpacing of the strip
  std::size_t profiled_ = 0;
};

}  // namespace algo
