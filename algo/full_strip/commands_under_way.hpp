// algo/full_strip/commands_under_way.hpp: commands that were sent and do not act yet.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "algo/full_strip/motion.hpp"

namespace algo {

/// Predicts the robot's state through the delay of its commands.
class CommandsUnderWay {
 public:
  void reset() { commands_.clear(); }
  /// Adapts to a delay of `delay` [s] with ticks of `dt` [s]. Call once per tick. Allocates only if
  /// the delay changes.
  void fit(double delay, double dt) {
    const auto ticks = static_cast<std::size_t>(std::lround(delay / dt));
    if (commands_.size() != ticks) commands_.assign(ticks, {});
  }
  /// Adds the command of this tick.
  void send(const Twist2& command) {
    if (commands_.empty()) return;
    std::rotate(commands_.begin(), commands_.begin() + 1, commands_.end());
    commands_.back() = command;
  }
  /// The state in which a command given now begins to act.
  MotionState state_when_acting(MotionState now, const MotionLimits& limits, double dt) const {
    for (const Twist2& command : commands_) now = advanced(now, command, limits, dt);
    return now;
  }
  /// [s] until a command given now acts.
  double lead(double dt) const { return dt * static_cast<double>(commands_.size()); }

 private:
  std::vector<Twist2> commands_{};  // oldest first
};

}  // namespace algo
