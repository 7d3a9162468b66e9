// drivers/clock.hpp: the time of a control loop, so that tests have their own.
#pragma once

namespace drivers {

/// [s] of a clock that never goes back and goes on while the machine is suspended.
double steady_now();

class Clock {
 public:
  Clock() = default;
  virtual ~Clock() = default;
  Clock(const Clock&) = delete;
  Clock& operator=(const Clock&) = delete;

  /// [s] never goes back.
  virtual double now() = 0;
  virtual void sleep_until(double time) = 0;
};

/// The system's, as the devices' threads have it.
class SteadyClock final : public Clock {
 public:
  double now() override { return steady_now(); }
  void sleep_until(double time) override;
};

}  // namespace drivers
