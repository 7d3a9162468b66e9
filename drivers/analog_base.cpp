// drivers/analog_base.cpp: speeds to volts, counts to a pose, and the relay that each tick renews.
#include "drivers/analog_base.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <utility>

namespace drivers {
namespace {

constexpr std::chrono::seconds kLookAgain{1};
constexpr double kSpeedWindow = 0.05;     // [s] over which counts become a speed
constexpr double kLeastInterval = 0.002;  // [s] between two readings of the card
constexpr double kLongestStep = 0.1;      // [s] one ramp step after a pause
constexpr double kFastestWheel = 10;      // [m/s] a faster change means the counter was reset

}  // namespace

AnalogBase::AnalogBase(std::string port, const AnalogSetup& setup, Opener open, double (*now)())
    : port_(std::move(port)),
      setup_(setup),
      open_(std::move(open)),
      now_(now),
      thread_([this](const std::stop_token& stop) { look_for_card(stop); }) {}

/// The amplifiers brake at 0 V until the relay's own watchdog opens it.
AnalogBase::~AnalogBase() {
  with_card([this](double now) { halt(now); });
}

WheelDynamics AnalogBase::dynamics() const {
  return {.ramps = {setup_.limits.acceleration, setup_.limits.turn_acceleration},
          .resolution = metres(1) / kSpeedWindow};
}

double AnalogBase::metres(std::int64_t counts) const {
  return static_cast<double>(counts) * 2 * std::numbers::pi * setup_.wheel_radius /
         setup_.counts_per_turn;
}

// ---- opening and losing the card -------------------------------------------------------------

template <class Act>
void AnalogBase::with_card(Act&& act) noexcept {
  const std::lock_guard lock(mutex_);
  if (!card_) return;
  try {
    act(now_());
  } catch (const CardError& error) {
    trouble_ = error.what();
    gone_ = std::move(card_);
    on_ = false;
    off_.cancel();
    state_.running = false;
    changed_.notify_one();
  }
}

void AnalogBase::look_for_card(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    if (card_) {
      changed_.wait(lock, stop, [this] { return card_ == nullptr; });
      continue;
    }
    std::unique_ptr<AnalogCard> closing = std::move(gone_);
    lock.unlock();
    closing.reset();
    std::unique_ptr<AnalogCard> card;
    std::string trouble;
    try {
      card = open_();
    } catch (const CardError& error) {
      trouble = error.what();
    }
    lock.lock();
    if (card) {
      take(std::move(card));
    } else {
      trouble_ = std::move(trouble);
    }
    if (!card_) changed_.wait_for(lock, stop, kLookAgain, [] { return false; });
  }
}

/// Starts with a newly opened card at zero volts; its present counts become the origin.
void AnalogBase::take(std::unique_ptr<AnalogCard> card) {
  try {
    card->write({0, 0});
    inputs_ = card->read();
    facts_ = card->facts();
  } catch (const CardError& error) {
    trouble_ = error.what();
    return;
  }
  card_ = std::move(card);
  on_ = relay_line_ = false;
  told_ = {};
  speeds_ = {};
  state_.twist = {};
  state_.stamp = told_at_ = now_();
  reading_count_ = 0;
  note_reading(state_.stamp);
  state_.running = true;
  ++state_.set_ups;
}

// ---- commands --------------------------------------------------------------------------------

void AnalogBase::enable(bool on) {
  with_card([&](double now) {
    halt(now);
    if (on) {
      switch_power(true);
      pulse_relay();
    } else if (on_) {
      off_.begin(now, braking_time(setup_.limits));
    }
  });
}

void AnalogBase::cut() noexcept {
  with_card([this](double now) {
    switch_power(false);
    halt(now);
  });
}

void AnalogBase::drive(const algo::Twist2& twist) {
  with_card([&](double now) {
    measure(now);
    if (!on_ || off_.pending()) {
      halt(now);
      return;
    }
    const algo::Twist2 wanted = limited(twist, setup_.limits);
    const double dt = std::clamp(now - told_at_, 0.0, kLongestStep);
    told_at_ = now;
    told_.v = algo::towards(told_.v, wanted.v, setup_.limits.acceleration * dt);
    told_.omega = algo::towards(told_.omega, wanted.omega, setup_.limits.turn_acceleration * dt);
    const algo::SideMotion sides = algo::sides_of(told_, setup_.half_track);
    const auto volts = [this](double speed, double measured) {
      // Exactly 0 V at rest: encoder noise must not make the wheels creep.
      if (speed == 0) return 0.0;
      const double v = speed / setup_.speed_per_volt + setup_.gain * (speed - measured);
      return std::clamp(v, -setup_.max_volts, setup_.max_volts);
    };
    card_->write({volts(sides.left, speeds_.left), volts(sides.right, speeds_.right)});
    pulse_relay();
  });
}

void AnalogBase::stop() noexcept {
  with_card([this](double now) { halt(now); });
}

/// Zero volts. The relay stays closed: an amplifier without power does not brake.
void AnalogBase::halt(double now) {
  told_ = {};
  told_at_ = now;
  card_->write({0, 0});
  if (off_.due(now, state_)) switch_power(false);
  pulse_relay();
}

void AnalogBase::switch_power(bool on) {
  on_ = on;
  off_.cancel();
  card_->set_enabled(on);
}

void AnalogBase::pulse_relay() {
  if (!on_) return;
  relay_line_ = !relay_line_;
  card_->set_relay_line(relay_line_);
}

// ---- reports ---------------------------------------------------------------------------------

void AnalogBase::note_reading(double now) {
  readings_[reading_count_ % readings_.size()] = {now, inputs_.counts};
  ++reading_count_;
}

/// [m/s] since the newest reading at least kSpeedWindow old, else since the oldest one.
/// Returns the last speeds when there are fewer than two readings.
algo::SideMotion AnalogBase::speeds_by(double now) const {
  const std::size_t kept = std::min(reading_count_, readings_.size());
  if (kept < 2) return speeds_;
  std::size_t back = 2;
  const auto reading = [&]() -> const Reading& {
    return readings_[(reading_count_ - back) % readings_.size()];
  };
  while (back < kept && now - reading().time < kSpeedWindow) ++back;
  const Reading& then = reading();
  const auto speed = [&](std::size_t side) {
    return metres(algo::count_difference(inputs_.counts[side], then.counts[side])) /
           (now - then.time);
  };
  return {speed(0), speed(1)};
}

void AnalogBase::measure(double now) {
  const double dt = now - state_.stamp;
  if (dt < kLeastInterval) return;
  const CardInputs before = std::exchange(inputs_, card_->read());
  algo::WheelCounts moved{algo::count_difference(inputs_.counts[0], before.counts[0]),
                          algo::count_difference(inputs_.counts[1], before.counts[1])};
  const double furthest = kFastestWheel * dt;
  if (std::abs(metres(moved.left)) > furthest || std::abs(metres(moved.right)) > furthest) {
    moved = {};
    reading_count_ = 0;
  }
  const algo::DriveGeometry geometry{setup_.wheel_radius, setup_.half_track};
  state_.pose = algo::integrate_counts(geometry, setup_.counts_per_turn, state_.pose, moved);
  note_reading(now);
  speeds_ = speeds_by(now);
  state_.twist = algo::twist_of(speeds_, setup_.half_track);
  state_.stamp = now;
  state_.counts = inputs_.counts;
  state_.stop_button = inputs_.stop_button;
  state_.faulty = inputs_.fault;
  state_.bumper_front = inputs_.bumper_front;
  state_.bumper_rear = inputs_.bumper_rear;
}

BaseState AnalogBase::state() {
  with_card([this](double now) { measure(now); });
  const std::lock_guard lock(mutex_);
  state_.motors_on = on_ && inputs_.relay_closed.value_or(true);
  return state_;
}

algo::DeviceReport AnalogBase::report() {
  const std::lock_guard lock(mutex_);
  algo::DeviceReport out;
  out.name = "base";
  out.port = port_;
  out.well = card_ != nullptr && !inputs_.stop_button && !inputs_.fault;
  if (!card_) {
    out.sentence = trouble_;
    return out;
  }
  out.facts = facts_;
  if (inputs_.stop_button) {
    out.sentence = "Its stop button is pressed: release it, then arm.";
  } else if (inputs_.fault) {
    out.sentence = "An amplifier reports a fault.";
  } else {
    out.sentence = on_ ? "Well, motors on." : "Well, motors off.";
  }
  return out;
}

}  // namespace drivers
