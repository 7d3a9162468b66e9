// tests/server/run/forwarding_robot_test.cpp: a robot that stands before another one hides nothing.
#include "server/run/forwarding_robot.hpp"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <gtest/gtest.h>

namespace server {
namespace {

/// A robot with every capability.
class CapableRobot final : public algo::Robot,
                           public algo::Arming,
                           public algo::Editing,
                           public algo::Locating,
                           public algo::Publishing {
 public:
  const algo::RobotSpec& spec() const override { return spec_; }
  void reset(algo::Observation& observation) override { observation.stamp = 1; }
  bool step(const algo::Command& command, algo::Observation& observation) override {
    observation.stamp = command.base.v;
    return false;
  }
  double next_period() const override { return 0.125; }
  void stop() noexcept override { stopped = true; }
  algo::Arming* arming() override { return this; }
  algo::Editing* editing() override { return this; }
  algo::Locating* locating() override { return this; }
  algo::Publishing* publishing() override { return this; }
  std::optional<algo::GroundTruth> ground_truth() const override { return algo::GroundTruth{}; }
  void find_moved(algo::Recycled<algo::Moved>& moved) const override { moved.push_back({7, {}}); }

  std::optional<std::string> arm() override { return std::nullopt; }
  void disarm(const std::string&) override {}
  std::uint32_t epoch() const override { return 0; }
  algo::HealthReport health() const override { return {}; }
  std::optional<std::string> edit(const algo::Request&) override { return std::nullopt; }
  void place(const algo::SetInitialPose&) override {}
  std::optional<std::string> publish_tilt(double, double, double) override { return std::nullopt; }
  std::optional<std::string> publish_line(std::span<const algo::LinePixel>, double) override {
    return std::nullopt;
  }

  bool stopped = false;

 private:
  algo::RobotSpec spec_{};
};

class PlainForwarding final : public ForwardingRobot {
 public:
  explicit PlainForwarding(std::shared_ptr<algo::Robot> robot)
      : ForwardingRobot(std::move(robot)) {}
};

TEST(ForwardingRobot, HidesNothingOfTheRobotBehindIt) {
  const auto behind = std::make_shared<CapableRobot>();
  PlainForwarding robot(behind);
  EXPECT_EQ(&robot.spec(), &behind->spec());
  EXPECT_EQ(robot.arming(), behind->arming());
  EXPECT_EQ(robot.editing(), behind->editing());
  EXPECT_EQ(robot.locating(), behind->locating());
  EXPECT_EQ(robot.publishing(), behind->publishing());
  EXPECT_EQ(robot.next_period(), 0.125);
  EXPECT_TRUE(robot.ground_truth());

  algo::Observation observation;
  robot.reset(observation);
  EXPECT_EQ(observation.stamp, 1);
  algo::Command command;
  command.base.v = 0.25;
  EXPECT_FALSE(robot.step(command, observation));
  EXPECT_EQ(observation.stamp, 0.25);
  algo::Recycled<algo::Moved> moved;
  robot.find_moved(moved);
  EXPECT_EQ(moved.size(), 1U);
  robot.stop();
  EXPECT_TRUE(behind->stopped);
}

}  // namespace
}  // namespace server
