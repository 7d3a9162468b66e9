// algo/full_strip/progress_watch.hpp: for how long the robot has not got on.
#pragma once

#include <algorithm>

#include "algo/types.hpp"

namespace algo {

/// Two clocks. One runs while the robot stays in its place; the other stands still while it turns
/// or manoeuvres, too.
class ProgressWatch {
 public:
  static constexpr double kWay = 0.15;  // [m] that count as progress

  /// Both clocks begin anew at `here_W`.
  void restart(const Vec2& here_W, double now) {
    place_ = {here_W, now};
    progress_ = place_;
  }
  /// `busy`: turning or manoeuvring is progress, too.
  void see(const Vec2& here_W, double now, bool busy) {
    if ((here_W - place_.at_W).norm() > kWay) place_ = {here_W, now};
    if (busy || (here_W - progress_.at_W).norm() > kWay) progress_ = {here_W, now};
  }
  /// Standing still has its reason: the clock begins anew.
  void excuse_place(double now) { place_.since = now; }
  void excuse_progress(double now) { progress_.since = now; }

  double in_place(double now) const { return now - place_.since; }             // [s]
  double without_progress(double now) const { return now - progress_.since; }  // [s]

  /// `patience` [s], or three times what a slow robot needs for the distance that counts as
  /// progress.
  static double time_for(double patience, double max_v) {
    return std::max(patience, 3 * kWay / max_v);
  }

 private:
  struct Since {
    Vec2 at_W{0, 0};
    double since = 0;  // [s] run clock
  };
  Since place_{};
  Since progress_{};
};

}  // namespace algo
