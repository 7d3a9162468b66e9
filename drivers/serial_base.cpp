// drivers/serial_base.cpp: passes every call to the machine, under the line's lock.
#include "drivers/serial_base.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace drivers {

algo::Twist2 limited(const algo::Twist2& twist, const BaseLimits& limits) {
  const auto within = [](double value, double limit) {
    return std::isnan(value) ? 0.0 : std::clamp(value, -limit, limit);
  };
  return {within(twist.v, limits.speed), within(twist.omega, limits.turn)};
}

double braking_time(const BaseLimits& limits) {
  constexpr double kUntilFelt = 0.5;  // [s] until a report shows that the wheels obey
  return limits.speed / kEmergencyDeceleration + kUntilFelt;
}

SerialBase::SerialBase(std::string port, std::unique_ptr<BaseMachine> machine)
    : machine_(std::move(machine)), line_(std::move(port), *machine_) {}

void SerialBase::enable(bool on) {
  line_.with([&] { machine_->enable(steady_now(), on); });
}

void SerialBase::cut() noexcept {
  line_.with([&] { machine_->cut(steady_now()); });
}

void SerialBase::drive(const algo::Twist2& twist) {
  line_.with([&] { machine_->drive(steady_now(), twist); });
}

void SerialBase::stop() noexcept {
  line_.with([&] { machine_->halt(steady_now()); });
}

BaseState SerialBase::state() {
  BaseState out;
  line_.look([&] { out = machine_->state(); });
  return out;
}

algo::DeviceReport SerialBase::report() {
  algo::DeviceReport out;
  line_.look([&] { out = machine_->report(steady_now()); });
  out.name = "base";
  out.port = line_.path();
  return out;
}

}  // namespace drivers
