// algo/full_strip/velocity_stage.hpp: chooses the command of a tick and proves it safe first.
#pragma once

#include <optional>

#include "algo/full_strip/motion.hpp"
#include "algo/full_strip/node_strip.hpp"
#include "algo/full_strip/steering.hpp"
#include "algo/full_strip/weighing.hpp"

namespace algo {

/// The inputs of the stage in one tick.
struct StageInput {
  const LocalMap* map = nullptr;
  const NodeStrip* strip = nullptr;
  MotionState state{};  // when the new command begins to act
  MotionLimits limits{};
  CommandCourse course{};  // of the commands up to the last tick's
  double dt = 0;           // [s]
  double stop_at = -1;     // [m] along the strip, its end for now; negative: the goal
  /// The ends of the newest scan's beams close to the hull; null: none.
  const Recycled<Vec2>* close_W = nullptr;
};

/// Drives along the strip by pure pursuit. A command is admissible if the robot, following the
/// strip for kHorizon and then braking to rest, keeps its margin of room all the way and never
/// backs into unseen space. The margin is kMargin, and less for a motion that stays close to the
/// strip or begins with less room. The next tick then has an admissible command too: the rest of
/// the same motion. The same must hold if the robot brakes after this one tick, as it does when the
/// strip changes or a person presses Stop. Nor may the command bring the hull nearer to a return of
/// the newest scan that is almost within the scanner's error: a cell of the map keeps a mean, and
/// means cut corners.
class VelocityStage {
 public:
  static constexpr double kHorizon = 1.0;  // [s]
  static constexpr double kMargin = 0.03;  // [m] the scanner's own error may be half of it
  static constexpr double kEscape = 0.6;   // [s]

  /// A way to follow the strip: the share of its speed, and whether to stay close to it, which
  /// needs less room.
  struct Pace {
    double share = 1;
    bool close = false;
  };

  void set_hull(const HullCheck& hull) { hull_ = hull; }
  const HullCheck& hull() const { return hull_; }

  /// The first admissible command along the strip, in the order of the paces; else a turn on the
  /// spot of a disc at rest; nothing if there is neither. Records the candidates and the pass point
  /// in `out`.
  std::optional<Twist2> follow(const StageInput& in, Weighing& out);

  /// `wanted` if the robot can still brake to rest safely after one tick of it.
  std::optional<Twist2> proven(const StageInput& in, const Twist2& wanted, Weighing& out) const;

  /// A way out of a place that is too narrow, to be held for kEscape: the primitive whose clearance
  /// grows most and never falls.
  std::optional<Twist2> escape(const StageInput& in, Weighing& out) const;
  /// True if a running escape may go on for `horizon` [s].
  bool still_escapes(const StageInput& in,
                     const Twist2& twist,
                     double horizon,
                     Weighing& out) const;
  /// Straight back, as far as that is free.
  std::optional<Twist2> back_off(const StageInput& in, Weighing& out) const;

 private:
  static constexpr std::size_t kProfile = 28;  // nodes of the speed profile: 4 m
  void profile(const StageInput& in);
  double speed_at(double s) const;
  Twist2 pursue(const StageInput& in, const MotionState& state, double s, const Pace& pace) const;
  std::optional<Twist2> turned_in_place(const StageInput& in) const;
  bool nears_return(const StageInput& in, const Pose2& next_W) const;
  bool admissible(const StageInput& in, const Pace& pace, Twist2& first, Vec2& aim_W) const;
  bool holds(const StageInput& in, const Twist2& twist, double horizon, double& gain) const;

  HullCheck hull_{};
  std::array<double, kProfile> speed_{};  // [m/s] at each kSpacing of the strip
  std::size_t profiled_ = 0;
};

}  // namespace algo
