// server/run/matched_robot.hpp: a robot whose odometry is corrected by its scans, without a map
// known before.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "algo/full_strip/scan_points.hpp"
#include "algo/mapping/scan_odometry.hpp"
#include "server/run/forwarding_robot.hpp"

namespace server {

/// Stands between a run and any robot with a scanner that looks ahead, and puts the pose by matched
/// scans into the odometry of each observation, and the move of the map where a loop is closed.
/// The pipeline sees nothing but this observation. The record does not keep the moves yet, so a run
/// that closed a loop is not replayed to the same commands.
class MatchedRobot final : public ForwardingRobot {
 public:
  explicit MatchedRobot(std::shared_ptr<algo::Robot> robot) : ForwardingRobot(std::move(robot)) {}

  void reset(algo::Observation& observation) override;
  bool step(const algo::Command& command, algo::Observation& observation) override;

 private:
  void correct(algo::Observation& observation);

  algo::ScanPoints trail_{};  // by the wheels
  algo::ScanOdometry odometry_{};
  std::vector<algo::Vec2> points_R_{};
};

}  // namespace server
