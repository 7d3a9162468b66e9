// drivers/wheel_watch.hpp: whether the wheels turn as they were told.
#pragma once

#include <array>
#include <cstddef>

#include "algo/types.hpp"

namespace drivers {

/// How a base follows its commands and reports its wheels.
struct WheelDynamics {
  /// Each wheel has a ramp of its own; otherwise speed and turn have one each.
  bool ramp_of_wheels = false;
  /// [m/s2] of the left and the right wheel; or [m/s2] of the speed, [rad/s2] of the turn. 0: not
  /// known, it may be any.
  std::array<double, 2> ramps{};
  /// [m/s] of a wheel: the least difference that is told or reported.
  double resolution = 0;
  /// Reports carry a check value: a single one may be believed.
  bool checked = false;
};

/// Keeps the interval in which each wheel's speed must lie, from the commands of the last moments
/// and the base's ramps. Tolerances leave room for a tenth of slip, a base that reaches half its
/// ramp, and 0.3 s from a command to the report that shows it. Times are seconds of any one clock.
///
/// Not for two threads at once. Allocates nothing.
class WheelWatch {
 public:
  WheelWatch(const WheelDynamics& dynamics, double half_track);

  /// Forgets everything: the next report is believed, whatever it says.
  void restart();
  /// The base was told `twist`, or (`braking`) to stand by its emergency ramp.
  void command(double now, const algo::Twist2& twist, bool braking = false);
  /// The base reports `twist` [m/s], [rad/s] as of `stamp`; one of the same stamp is the same
  /// report. True when the wheels have turned otherwise than told, or an encoder stands still
  /// though its wheel must turn.
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
  /// What the reports have said without a break.
  struct Doubt {
    unsigned reports = 0;
    double way = 0;  // [m] a wheel that seems to stand must have gone at least
  };

  Axes axes_of(const algo::Twist2& twist) const;
  void follow(double until);
  std::array<Interval, 2> wheels() const;

  WheelDynamics dynamics_;
  double half_track_;
  std::array<Told, 64> told_{};  // a ring, the oldest overwritten
  std::size_t told_count_ = 0;   // since the restart
  bool begun_ = false;
  double stamp_ = 0;  // [s] of the newest report
  std::array<Interval, 2> axes_{};
  Doubt too_fast_{};
  Doubt too_slow_{};
};

}  // namespace drivers
