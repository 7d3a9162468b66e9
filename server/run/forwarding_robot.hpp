// server/run/forwarding_robot.hpp: a robot that stands before another one.
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "algo/robot.hpp"

namespace server {

/// Passes each call on to the robot behind it. A derived class overrides the calls that it changes.
class ForwardingRobot : public algo::Robot {
 public:
  const algo::RobotSpec& spec() const override { return robot_->spec(); }
  void reset(algo::Observation& observation) override { robot_->reset(observation); }
  bool step(const algo::Command& command, algo::Observation& observation) override {
    return robot_->step(command, observation);
  }
  double next_period() const override { return robot_->next_period(); }
  void stop() noexcept override { robot_->stop(); }
  algo::Arming* arming() override { return robot_->arming(); }
  algo::Editing* editing() override { return robot_->editing(); }
  std::optional<algo::GroundTruth> ground_truth() const override { return robot_->ground_truth(); }
  void find_moved(algo::Recycled<algo::Moved>& moved) const override { robot_->find_moved(moved); }
  algo::Locating* locating() override { return robot_->locating(); }
  algo::Publishing* publishing() override { return robot_->publishing(); }

 protected:
  explicit ForwardingRobot(std::shared_ptr<algo::Robot> robot) : robot_(std::move(robot)) {}

 private:
  std::shared_ptr<algo::Robot> robot_;
};

}  // namespace server
