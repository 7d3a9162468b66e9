// drivers/clock.hpp: the clock of a control loop; tests substitute their own.
#pragma once

namespace drivers {

/// [s] of a clock that never goes back and counts while the computer is suspended.
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

/// The system's clock, which the device threads use too.
class SteadyClock final : public Clock {
 public:
  double now() override { return steady_now(); }
  void sleep_until(double time) override;
};

}  // namespace drivers
