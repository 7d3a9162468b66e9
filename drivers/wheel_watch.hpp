// drivers/wheel_watch.hpp: checks whether the wheels follow their commands.
#pragma once

#include <array>
#include <cstddef>

#include "algo/types.hpp"

namespace drivers {

/// How a base follows its commands and reports its wheels.
struct WheelDynamics {
  /// True: one ramp per wheel. False: one for the speed and one for the turn.
  bool ramp_of_wheels = false;
  /// [m/s2] of the left and the right wheel; or [m/s2] of the speed, [rad/s2] of the turn. 0:
  /// unknown, any ramp is possible.
  std::array<double, 2> ramps{};
  /// [m/s] of a wheel: the resolution of commands or reports.
  double resolution = 0;
  /// Reports carry a check value, so a single one may be trusted.
  bool checked = false;
};

/// Keeps the interval in which each wheel's speed must lie, from recent commands and the base's
/// ramps. It tolerates 10 % slip, a base that reaches half its ramp, and 0.3 s from a command to
/// the report that shows it. Times are seconds of any one clock.
///
/// Not thread-safe. Allocates nothing.
class WheelWatch {
 public:
  WheelWatch(const WheelDynamics& dynamics, double half_track);

  /// Resets: the next report is accepted without a check.
  void restart();
  /// Records a command: `twist`, or with `braking` an emergency stop.
  void command(double now, const algo::Twist2& twist, bool braking = false);
  /// Checks a report of `twist` [m/s], [rad/s] at `stamp`; the same stamp means the same report.
  /// True when the wheels have not followed their commands, or an encoder stands still though its
  /// wheel must turn.
  bool report(double stamp, const algo::Twist2& twist);

 private:
  struct Interval {
    double low = 0;
    double high = 0;
  };
  /// Left and right wheel, or speed and turn.
  using Axes = std::array<double, 2>;
  struct Told {
    double time = 0;  // [s]
    Axes wanted{};
    bool braking = false;
  };
  /// Consecutive reports that agree.
  struct Doubt {
    unsigned reports = 0;
    double way = 0;  // [m] least travel of a wheel that seems to stand
  };

  Axes axes_of(const algo::Twist2& twist) const;
  void follow(double until);
  std::array<Interval, 2> wheels() const;

  WheelDynamics dynamics_;
  double half_track_;
  std::array<Told, 64> told_{};  // ring buffer
  std::size_t told_count_ = 0;   // since the restart
  bool begun_ = false;
  double stamp_ = 0;  // [s] of the newest report
  std::array<Interval, 2> axes_{};
  Doubt too_fast_{};
  Doubt too_slow_{};
};

}  // namespace drivers
