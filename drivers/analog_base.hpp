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
#include <utility>
#include <vector>

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
  double watchdog = 0.2;          // [s] from the last change of the relay's line until it opens
  BaseLimits limits{};
};

/// Feed-forward plus a proportional term, ramps within the limits, dead reckoning. Each drive() and
/// stop() toggles the relay's line once: without control ticks the relay opens by itself.
///
/// A thread of its own keeps trying to open a missing card.
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

  /// Calls `act(now)` with the card, under the lock; does nothing without a card. A card that
  /// throws counts as lost.
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
  std::unique_ptr<AnalogCard> card_{};  // nullptr while it is missing
  std::unique_ptr<AnalogCard> gone_{};  // lost: closed by the thread, which may block
  std::vector<std::pair<std::string, std::string>> facts_{};  // of the card
  std::string trouble_ = "The card is being opened.";
  bool on_ = false;  // the relay should be closed
  bool relay_line_ = false;
  SwitchingOff off_{};
  algo::Twist2 told_{};  // the present output of the ramps
  double told_at_ = 0;   // [s]
  CardInputs inputs_{};
  std::array<Reading, 32> readings_{};  // ring buffer
  std::size_t reading_count_ = 0;       // since the card was opened
  algo::SideMotion speeds_{};           // [m/s] measured
  BaseState state_{};
  std::jthread thread_{};  // declared last: ends first
};

}  // namespace drivers
