// drivers/analog_base.hpp: a base without a protocol: volts to the motor amplifiers, counts from
// the encoders. docs/adr/0018-comedi.md.
#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "algo/diff_drive.hpp"
#include "drivers/analog_card.hpp"
#include "drivers/base.hpp"
#include "drivers/base_machine.hpp"
#include "drivers/clock.hpp"

namespace drivers {

struct AnalogSetup {
  double wheel_radius = 0.1;      // [m]
  double half_track = 0.25;       // [m]
  double counts_per_turn = 2000;  // of the wheel
  double speed_per_volt = 0.1;    // [m/s V] of the wheel's rim
  double max_volts = 10;          // [V] to an amplifier
  double gain = 0;                // [V s/m] of the proportional part on the speed's error
  double watchdog = 0.2;          // [s] after the last change of its line the relay opens
  BaseLimits limits{};
};

/// Feed-forward with a proportional part, ramps within the limits, dead reckoning. Each drive() and
/// stop() changes the relay's line once: the relay opens by itself when the control tick is silent.
///
/// A card that is not there, or has gone, is looked for by a thread of its own.
class AnalogBase final : public Base {
 public:
  /// Opens the card. Throws CardError.
  using Opener = std::function<std::unique_ptr<AnalogCard>()>;

  /// `now` gives the seconds of a steady clock.
  AnalogBase(std::string port, const AnalogSetup& setup, Opener open, double (*now)() = steady_now);
  ~AnalogBase() override;

  void enable(bool on) override;
  void cut() noexcept override;
  void drive(const algo::Twist2& twist) override;
  void stop() noexcept override;
  BaseState state() override;
  double watchdog() const override { return setup_.watchdog; }
  WheelDynamics dynamics() const override;
  algo::DeviceReport report() override;

 private:
  struct Reading {
    double time = 0;  // [s]
    std::array<std::uint32_t, 2> counts{};
  };

  /// `act(now)` with the card, under the lock; nothing without one. A card that fails has gone.
  template <class Act>
  void with_card(Act&& act) noexcept;
  void look_for_card(const std::stop_token& stop);
  void take(std::unique_ptr<AnalogCard> card);
  void measure(double now);
  void note_reading(double now);
  algo::SideMotion speeds_by(double now) const;
  void halt(double now);
  void switch_power(bool on);
  void pulse_relay();
  double metres(std::int64_t counts) const;

  const std::string port_;
  const AnalogSetup setup_;
  const Opener open_;
  double (*const now_)();

  std::mutex mutex_{};  // stop() and report() come from other threads
  std::condition_variable_any changed_{};
  std::unique_ptr<AnalogCard> card_{};  // none while it is looked for
  std::unique_ptr<AnalogCard> gone_{};  // to be closed by the thread, which may wait
  std::string trouble_ = "The card is being opened.";
  bool on_ = false;  // the relay is to be closed
  bool relay_line_ = false;
  SwitchingOff off_{};
  algo::Twist2 told_{};  // as the ramps have it
  double told_at_ = 0;   // [s]
  CardInputs inputs_{};
  std::array<Reading, 32> readings_{};  // a ring, the oldest overwritten
  std::size_t reading_count_ = 0;       // since the card was opened
  algo::SideMotion speeds_{};           // [m/s] measured
  BaseState state_{};
  std::jthread thread_{};  // last: ends first
};

}  // namespace drivers
