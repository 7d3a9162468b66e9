// drivers/base_machine.hpp: what the machines of serial bases have in common.
#pragma once

#include <string>

#include "drivers/base.hpp"
#include "drivers/machine.hpp"

namespace drivers {

class BaseMachine : public Machine {
 public:
  /// As Base has them. Commands are sent by these calls alone, never by the passing of time.
  virtual void enable(double now, bool on) = 0;
  virtual void drive(double now, const algo::Twist2& twist) = 0;
  virtual void halt(double now) = 0;
  virtual const BaseState& state() const = 0;
  virtual double watchdog() const = 0;
  /// Name and port are the caller's.
  virtual DeviceReport report(double now) const = 0;
};

}  // namespace drivers
