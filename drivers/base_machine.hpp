// drivers/base_machine.hpp: what the machines of serial bases have in common.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "drivers/base.hpp"
#include "drivers/machine.hpp"

namespace drivers {

/// [s] after which an order to move is not sent any more.
constexpr double kMotionExpires = 0.25;

/// Motors that are to go off once the wheels stand.
class SwitchingOff {
 public:
  /// `longest` [s] from now the motors go off whatever the wheels do.
  void begin(double now, double longest) {
    if (pending()) return;
    begun_ = now;
    until_ = now + longest;
  }
  void cancel() { until_ = kNever; }
  bool pending() const { return until_ < kNever; }
  /// [s] when it is due at the latest.
  double until() const { return until_; }
  /// Whether the wheels stand, as a report of after the beginning says, or the time is over.
  bool due(double now, const BaseState& state) const {
    constexpr double kStill = 0.01;  // [m/s], [rad/s]
    const bool still = state.running && state.stamp > begun_ && std::abs(state.twist.v) < kStill &&
                       std::abs(state.twist.omega) < kStill;
    return pending() && (still || now >= until_);
  }

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();
  double begun_ = 0;       // [s]
  double until_ = kNever;  // [s]
};

class BaseMachine : public Machine {
 public:
  /// As Base has them. Motion is commanded by these calls alone, never by the passing of time.
  virtual void enable(double now, bool on) = 0;
  virtual void cut(double now) = 0;
  virtual void drive(double now, const algo::Twist2& twist) = 0;
  virtual void halt(double now) = 0;
  virtual const BaseState& state() const = 0;
  virtual double watchdog() const = 0;
  virtual WheelDynamics dynamics() const = 0;
  /// Name and port are the caller's.
  virtual algo::DeviceReport report(double now) const = 0;
};

}  // namespace drivers
