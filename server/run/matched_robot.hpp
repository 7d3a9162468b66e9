// server/run/matched_robot.hpp: a robot whose odometry is corrected by its scans, without a map
// known before.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "algo/full_strip/scan_points.hpp"
#include "algo/mapping/scan_odometry.hpp"
#include "algo/robot.hpp"

namespace server {

/// Stands between a run and any robot with a scanner that looks ahead, and puts the pose by matched
/// scans into the odometry of each observation. Pipeline and record see nothing but this
/// observation, so a replay needs no matcher.
class MatchedRobot final : public algo::Robot {
 public:
  explicit MatchedRobot(std::unique_ptr<algo::Robot> robot) : robot_(std::move(robot)) {}

  const algo::RobotSpec& spec() const override { return robot_->spec(); }
  void reset(algo::Observation& observation) override;
  bool step(const algo::Command& command, algo::Observation& observation) override;
  double next_period() const override { return robot_->next_period(); }
  void stop() noexcept override { robot_->stop(); }
  algo::Arming* arming() override { return robot_->arming(); }
  algo::Editing* editing() override { return robot_->editing(); }
  algo::Publishing* publishing() override { return robot_->publishing(); }
  algo::Locating* locating() override { return robot_->locating(); }
  std::optional<algo::GroundTruth> ground_truth() const override { return robot_->ground_truth(); }
  void find_moved(algo::Recycled<algo::Moved>& moved) const override { robot_->find_moved(moved); }

 private:
  void correct(algo::Observation& observation);

  std::unique_ptr<algo::Robot> robot_;
  algo::ScanPoints trail_{};  // by the wheels
  algo::ScanOdometry odometry_{};
  std::vector<algo::Vec2> points_R_{};
};

}  // namespace server
