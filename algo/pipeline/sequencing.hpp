// algo/pipeline/sequencing.hpp: the sequencing layer: idle, driving, arrived, stuck, held.
#pragma once

#include <cstddef>
#include <vector>

#include "algo/intent.hpp"
#include "algo/telemetry.hpp"

namespace algo {

/// Stuck: all positions in the window lie within 60 mm of the present one; window = max(20 s, 0.8 m
/// / v_max). Allocates only in reset().
class StuckDetector {
 public:
  /// `period` [s] of one tick, > 0.
  void reset(double period);
  /// Starts a new window, as for a new goal.
  void restart() { count_ = 0; }
  bool update(const Vec2& position_W, double v_max);
  static double window(double v_max);  // [s]

 private:
  double period_ = 0;
  std::vector<Vec2> ring_{};
  std::size_t next_ = 0;
  std::size_t count_ = 0;
};

/// The goal's state machine. A stuck robot keeps trying, and counts as driving again once it gets
/// away. An arrived robot waits for the next goal.
class Sequencer {
 public:
  void reset(double period);
  /// The goals were replaced (Intent::apply).
  void begin(const Intent& intent);
  /// The robot was held: standing still then does not mean stuck.
  void interrupt() { stuck_.restart(); }
  /// The state for this tick, before control; `pose_W` is the odometry's. A reached goal of
  /// `intent` gives way to the next; the robot arrives only at the last.
  Mission update(const Pose2& pose_W, Intent& intent);
  /// The newest state.
  Mission mission() const { return mission_; }

 private:
  void go_on(Intent& intent);  // to the next goal

  Mission mission_ = Mission::Idle;
  StuckDetector stuck_{};
  Vec2 stuck_at_W_{0, 0};
};

}  // namespace algo
