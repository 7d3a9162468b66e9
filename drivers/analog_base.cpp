// drivers/analog_base.cpp: speeds as volts, counts as a pose.
#include "drivers/analog_base.hpp"

#include <algorithm>
#include <numbers>

#include "algo/diff_drive.hpp"

namespace drivers {

AnalogBase::AnalogBase(AnalogCard& card, const AnalogSetup& setup, double (*now)())
    : card_(card), setup_(setup), now_(now), counts_(card.read_counts()) {
  card_.write_volts({0, 0});
  card_.enable(false);
  state_.running = true;
  state_.set_ups = 1;
  state_.stamp = now_();
}

void AnalogBase::enable(bool on) {
  const std::lock_guard lock(mutex_);
  card_.write_volts({0, 0});
  card_.enable(on);
}

void AnalogBase::cut() noexcept {
  const std::lock_guard lock(mutex_);
  card_.write_volts({0, 0});
  card_.enable(false);
}

void AnalogBase::drive(const algo::Twist2& twist) {
  const std::lock_guard lock(mutex_);
  measure();
  const algo::Twist2 wanted = limited(twist, setup_.limits);
  const algo::SideMotion sides = algo::sides_of(wanted, setup_.half_track);
  const std::array<double, 2> speeds{sides.left, sides.right};
  std::array<double, 2> volts{};
  for (std::size_t i = 0; i < volts.size(); ++i) {
    // At rest nothing but zero: noise of the encoders must not creep.
    if (speeds[i] == 0) continue;
    const double v =
        speeds[i] / setup_.metres_per_second_volt + setup_.gain * (speeds[i] - speeds_[i]);
    volts[i] = std::clamp(v, -setup_.max_volts, setup_.max_volts);
  }
  card_.write_volts(volts);
}

void AnalogBase::stop() noexcept {
  const std::lock_guard lock(mutex_);
  card_.write_volts({0, 0});
}

void AnalogBase::measure() {
  const double now = now_();
  const std::array<std::uint32_t, 2> counts = card_.read_counts();
  const algo::WheelCounts moved{algo::count_difference(counts[0], counts_[0]),
                                algo::count_difference(counts[1], counts_[1])};
  const algo::DriveGeometry geometry{setup_.wheel_radius, setup_.half_track};
  state_.pose = algo::integrate_counts(geometry, setup_.counts_per_turn, state_.pose, moved);
  const double dt = now - state_.stamp;
  if (dt > 0) {
    const double metres = 2 * std::numbers::pi * setup_.wheel_radius / setup_.counts_per_turn;
    speeds_ = {static_cast<double>(moved.left) * metres / dt,
               static_cast<double>(moved.right) * metres / dt};
    state_.twist = algo::twist_of({speeds_[0], speeds_[1]}, setup_.half_track);
  }
  counts_ = counts;
  state_.counts = counts;
  state_.stamp = now;
}

BaseState AnalogBase::state() {
  const std::lock_guard lock(mutex_);
  state_.motors_on = card_.enabled();
  return state_;
}

algo::DeviceReport AnalogBase::report() {
  const std::lock_guard lock(mutex_);
  algo::DeviceReport out;
  out.name = "base";
  out.well = true;
  out.sentence = card_.enabled() ? "Well, motors on." : "Well, motors off.";
  out.facts = {{"kind", "analog"}};
  return out;
}

}  // namespace drivers
