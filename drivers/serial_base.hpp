// drivers/serial_base.hpp: a base on a serial line: its machine and its thread.
#pragma once

#include <memory>
#include <string>

#include "drivers/base_machine.hpp"
#include "drivers/line_thread.hpp"

namespace drivers {

class SerialBase final : public Base {
 public:
  SerialBase(std::string port, std::unique_ptr<BaseMachine> machine);

  void enable(bool on) override;
  void cut() noexcept override;
  void drive(const algo::Twist2& twist) override;
  void stop() noexcept override;
  BaseState state() override;
  double watchdog() const override { return machine_->watchdog(); }
  WheelDynamics dynamics() const override { return machine_->dynamics(); }
  algo::DeviceReport report() override;

 private:
  std::unique_ptr<BaseMachine> machine_;
  LineThread line_;  // declared last: ends first
};

}  // namespace drivers
