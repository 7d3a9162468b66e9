// algo/full_strip/recovery.hpp: motions that need no strip: out of a place that is too narrow, and
// back after a long blockage.
#pragma once

#include <optional>

#include "algo/full_strip/strip_state.hpp"
#include "algo/full_strip/velocity_stage.hpp"

namespace algo {

class Recovery {
 public:
  void reset();
  /// Backs off for a while.
  void begin_backing(double now);
  /// True while it backs off or escapes.
  bool active(double now) const;

  /// A motion out of the present place; nothing if the robot had better stand. `speed` [m/s]: an
  /// escape begins at rest.
  std::optional<StripCommand> next(
      const StageInput& stage, const VelocityStage& proof, double speed, double now, Weighing& out);
  /// True if the last command was the first of an escape.
  bool begins_escape() const { return begins_escape_; }

 private:
  /// An escape runs to its end: starting and stopping it each tick would lead nowhere.
  struct Escape {
    Twist2 twist{};
    double until = 0;  // [s] run clock
  };
  double back_until_ = -1;  // [s] run clock
  std::optional<Escape> escape_{};
  bool begins_escape_ = false;
};

}  // namespace algo
