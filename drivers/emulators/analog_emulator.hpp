// drivers/emulators/analog_emulator.hpp: amplifiers, encoders, relay and switches around an
// emulated acquisition card.
#pragma once

#include <array>
#include <cstdint>

#include "drivers/emulators/base.hpp"
#include "drivers/emulators/card_memory.hpp"

namespace drivers::emulators {

struct AnalogOptions {
  double wheel_radius = 0.1;      // [m]
  double counts_per_turn = 2000;  // of the wheel
  double speed_per_volt = 0.1;    // [m/s V]
  double watchdog = 0.2;          // [s] the relay stays closed after a change of its line
  std::uint32_t first_count = 0;  // initial value of both counters
};

/// Wiring: output 0 and counter 0 to the left wheel, output 1 and counter 1 to the right wheel.
/// Digital lines: 0 drives the relay; 1 is high while the relay is closed; 2 is low while the stop
/// button is pressed; 3 is low at a fault; 4 is high while the front bumper is hit; 5 drives the
/// amplifiers' enable input, if the host has made it an output.
class AnalogEmulator final : public Base {
 public:
  explicit AnalogEmulator(const AnalogOptions& options = {}) : options_(options) {
    counts_.fill(options.first_count);
  }

  /// Plugs in a newly powered card; nullptr: unplugs it.
  void attach(CardMemory* card);

  void feel(const BaseSenses& senses, double now) override;
  WheelMotion drive(double now) override;
  void press_stop_button(bool pressed) override { stop_pressed_ = pressed; }
  void press_bumper(bool pressed) override { bumper_pressed_ = pressed; }
  void set_battery(double volts) override { volts_ = volts; }
  /// Fault bits of the amplifiers; any bit is a fault.
  void set_faults_reported(std::uint16_t bits) override { faults_ = bits; }
  bool powered() const override { return powered_; }
  /// The card loses its power: voltages and counters become zero, and every call fails until the
  /// end.
  void restart(double now, double boot_time) override;
  /// Every call fails until then.
  void mute(double until) { busy_until_ = until; }

 private:
  bool fault() const;
  bool relay_closed(double now) const;
  bool enabled() const;
  void show_lines();

  AnalogOptions options_;
  CardMemory* card_ = nullptr;
  double busy_until_ = -1;
  double driven_until_ = -1;  // [s]
  WheelMotion told_{};        // commanded by the voltages, as last reported
  WheelMotion motion_{};      // produced by the amplifiers
  bool powered_ = false;
  bool relay_closed_ = false;
  bool stop_pressed_ = false;
  bool bumper_pressed_ = false;
  bool hit_ = false;
  double volts_ = 24;  // of the battery
  std::uint16_t faults_ = 0;
  WheelMotion travel_{};            // [m] measured so far
  std::array<double, 2> counts_{};  // not wrapped
};

}  // namespace drivers::emulators
