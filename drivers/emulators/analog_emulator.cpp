// drivers/emulators/analog_emulator.cpp: voltages turn the wheels while the relay is closed.
#include "drivers/emulators/analog_emulator.hpp"

#include <cmath>
#include <numbers>

namespace drivers::emulators {
namespace {

constexpr double kDeadBand = 1e-3;   // [V] an amplifier reads smaller voltages as 0
constexpr double kRamp = 1.5;        // [m/s2] of a wheel with power
constexpr double kCoasting = 0.8;    // [m/s2] of one without
constexpr double kLowestVolts = 20;  // [V] of the battery; below, the amplifiers stop

enum DigitalLine : std::uint32_t {
  RelayClosed = 1,
  StopReleased = 2,
  Well = 3,
  Bumper = 4,
  Enable = 5
};

std::uint32_t bit(DigitalLine line, bool high) {
  return high ? 1U << line : 0U;
}

}  // namespace

void AnalogEmulator::attach(CardMemory* card) {
  card_ = card;
  if (card_ != nullptr) show_lines();
}

bool AnalogEmulator::fault() const {
  return faults_ != 0 || volts_ < kLowestVolts;
}

bool AnalogEmulator::relay_closed(double now) const {
  return card_ != nullptr && card_->relay_changes > 0 && !stop_pressed_ &&
         now - card_->relay_changed_at <= options_.watchdog;
}

bool AnalogEmulator::enabled() const {
  const std::uint32_t input = bit(Enable, true);
  return (card_->directions & input) == 0 || (card_->levels & input) != 0;
}

WheelMotion AnalogEmulator::drive(double now) {
  const double dt = driven_until_ >= 0 ? now - driven_until_ : 0;
  driven_until_ = now;
  if (card_ != nullptr) card_->busy = now < busy_until_ ? 1 : 0;
  relay_closed_ = relay_closed(now);
  powered_ = relay_closed_ && enabled() && !fault();
  const auto speed = [this](std::size_t output) {
    const double volts = powered_ ? card_->volts(output) : 0;
    return std::abs(volts) < kDeadBand ? 0 : volts * options_.speed_per_volt;
  };
  const WheelMotion told{.left = speed(0), .right = speed(1)};
  if (told != told_) report(now, told);
  told_ = told;
  const double most = (powered_ ? kRamp : kCoasting) * dt;
  motion_.left = towards(motion_.left, told.left, most);
  motion_.right = towards(motion_.right, told.right, most);
  show_lines();
  return motion_;
}

void AnalogEmulator::feel(const BaseSenses& senses, double now) {
  const double per_metre =
      options_.counts_per_turn / (2 * std::numbers::pi * options_.wheel_radius);
  counts_[0] += (senses.left_travel - travel_.left) * per_metre;
  counts_[1] += (senses.right_travel - travel_.right) * per_metre;
  travel_ = {senses.left_travel, senses.right_travel};
  hit_ = senses.front_bumper;
  if (card_ != nullptr) {
    card_->turned[0] = counts_[0];
    card_->turned[1] = counts_[1];
    card_->rates[0] = senses.motion.left * per_metre;
    card_->rates[1] = senses.motion.right * per_metre;
    card_->turned_at = now;
  }
  show_lines();
}

void AnalogEmulator::show_lines() {
  if (card_ == nullptr) return;
  card_->inputs = bit(RelayClosed, relay_closed_) | bit(StopReleased, !stop_pressed_) |
                  bit(Well, !fault()) | bit(Bumper, bumper_pressed_ || hit_);
}

void AnalogEmulator::restart(double now, double boot_time) {
  busy_until_ = now + boot_time;
  counts_ = {};
  if (card_ == nullptr) return;
  card_->reset();
  card_->busy = 1;
}

}  // namespace drivers::emulators
