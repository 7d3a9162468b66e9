// drivers/base_machine.hpp: the common interface of the protocol machines of serial bases.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "drivers/base.hpp"
#include "drivers/machine.hpp"

namespace drivers {

/// [s] A motion order older than this is not sent.
constexpr double kMotionExpires = 0.25;

/// Delays switching the motors off until the wheels stand.
class SwitchingOff {
 public:
  /// The motors go off `longest` [s] from `now` at the latest, even if the wheels still turn.
  void begin(double now, double longest) {
    if (pending()) return;
    begun_ = now;
    until_ = now + longest;
  }
  void cancel() { until_ = kNever; }
  bool pending() const { return until_ < kNever; }
  /// [s] The latest time to switch off.
  double until() const { return until_; }
  /// True once a report made after the start says that the wheels stand, or the time is over.
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

/// What the machines of all bases share: the queue of orders, the wait for an answer, the newest
/// state, and braking until the motors go off.
class BaseMachine : public Machine {
 public:
  double wake_time() const override { return std::min(deadline_, off_.until()); }
  std::optional<LineOrder> next_order() override { return orders_.next(); }

  /// As in Base. Only these calls command motion; time alone never does.
  virtual void enable(double now, bool on) = 0;
  virtual void cut(double now) = 0;
  virtual void drive(double now, const algo::Twist2& twist) = 0;
  virtual void halt(double now) = 0;
  const BaseState& state() const { return state_; }
  virtual double watchdog() const = 0;
  virtual WheelDynamics dynamics() const = 0;
  /// The caller fills name and port.
  virtual algo::DeviceReport report(double now) const = 0;

 protected:
  /// For closed().
  void lose_line(const std::string& why) {
    orders_.clear();
    state_.running = false;
    state_.motors_on = false;
    off_.cancel();
    trouble_ = why;
    deadline_ = std::numeric_limits<double>::infinity();
  }

  LineOrders orders_{};
  int tries_left_ = 0;
  double deadline_ = 0;         // [s]
  double searching_since_ = 0;  // [s]
  std::string trouble_{"The port has not been opened yet."};
  BaseState state_{};
  bool braking_ = false;      // until the next motion command
  double braking_since_ = 0;  // [s]
  SwitchingOff off_{};
};

}  // namespace drivers
