// drivers/analog_base.hpp: bases without a protocol: volts out to the motor amplifiers, counts in
// from the encoders, as on the Silvermate and on Park's robot.
//
// The card is an interface: such wiring differs from robot to robot, and none was at hand. See
// docs/adr/0008-real-time-and-the-analog-base.md.
#pragma once

#include <array>
#include <cstdint>
#include <mutex>

#include "drivers/base.hpp"

namespace drivers {

/// Two channels of a data acquisition card: left, right. Calls do not wait.
class AnalogCard {
 public:
  AnalogCard() = default;
  virtual ~AnalogCard() = default;
  AnalogCard(const AnalogCard&) = delete;
  AnalogCard& operator=(const AnalogCard&) = delete;

  /// [V] to the amplifiers. A card without a watchdog keeps them when the program dies: it then
  /// needs a relay that a living program holds.
  virtual void write_volts(const std::array<double, 2>& volts) = 0;
  /// Of the encoders, modulo 2^32.
  virtual std::array<std::uint32_t, 2> read_counts() = 0;
  /// The amplifiers' relay.
  virtual void enable(bool on) = 0;
  virtual bool enabled() const = 0;
  /// [s] after which the card or its relay stops the motors by itself; 0: never.
  virtual double watchdog() const = 0;
};

struct AnalogSetup {
  double wheel_radius = 0.1;            // [m]
  double half_track = 0.25;             // [m]
  double counts_per_turn = 2000;        // of the wheel
  double metres_per_second_volt = 0.1;  // of the wheel's rim
  double max_volts = 10;
  double gain = 0;  // [V s/m] of the proportional part on the speed's error
  BaseLimits limits{};
};

/// Feed-forward with a proportional part, and dead reckoning, once per control tick.
class AnalogBase final : public Base {
 public:
  /// `card` outlives it. `now` gives the seconds of a steady clock.
  AnalogBase(AnalogCard& card, const AnalogSetup& setup, double (*now)());

  /// Off at once: nobody but the control tick would see the wheels come to rest.
  void enable(bool on) override;
  void cut() noexcept override;
  void drive(const algo::Twist2& twist) override;
  void stop() noexcept override;
  BaseState state() override;
  double watchdog() const override { return card_.watchdog(); }
  algo::DeviceReport report() override;

 private:
  void measure();

  AnalogCard& card_;
  AnalogSetup setup_;
  double (*now_)();
  std::mutex mutex_{};  // stop() and report() come from other threads
  std::array<std::uint32_t, 2> counts_{};
  std::array<double, 2> speeds_{};  // [m/s] measured
  BaseState state_{};
};

}  // namespace drivers
