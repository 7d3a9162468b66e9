// server/run/hardware.hpp: a robot of real devices as the source of runs.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "algo/robot.hpp"
#include "drivers/serial_robot.hpp"
#include "server/run/run_spec.hpp"

namespace server {

/// One run of hardware that outlives it: devices stay open from run to run. Ends disarmed.
class HardwareRun final : public algo::Robot {
 public:
  explicit HardwareRun(std::shared_ptr<drivers::SerialRobot> robot) : robot_(std::move(robot)) {}
  ~HardwareRun() override { robot_->disarm(); }
  HardwareRun(const HardwareRun&) = delete;
  HardwareRun& operator=(const HardwareRun&) = delete;

  const algo::RobotSpec& spec() const override { return robot_->spec(); }
  void reset(algo::Observation& observation) override { robot_->reset(observation); }
  bool step(const algo::Command& command, algo::Observation& observation) override {
    return robot_->step(command, observation);
  }
  void stop() noexcept override { robot_->stop(); }
  std::optional<std::string> edit(const algo::Request& request) override {
    return robot_->edit(request);
  }
  std::uint64_t missed_periods() const override { return robot_->missed_periods(); }

 private:
  std::shared_ptr<drivers::SerialRobot> robot_;
};

/// The spec of runs on `robot`: an empty world without a goal, the file's controller and limits.
/// Throws DocumentError.
RunSpec hardware_spec(std::shared_ptr<drivers::SerialRobot> robot, const RunOverrides& overrides);

/// As in docs/interfaces.md.
nlohmann::json to_json(const drivers::HardwareReport& report);

}  // namespace server
