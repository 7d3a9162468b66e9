// server/run/matched_robot.cpp: wheels and scans in, the corrected pose out.
#include "server/run/matched_robot.hpp"

#include <utility>

#include "algo/perceive.hpp"

namespace server {

void MatchedRobot::reset(algo::Observation& observation) {
  ForwardingRobot::reset(observation);
  trail_.reset();
  odometry_.reset(observation.odometry.pose, observation.odometry.pose);
  correct(observation);
}

bool MatchedRobot::step(const algo::Command& command, algo::Observation& observation) {
  if (!ForwardingRobot::step(command, observation)) return false;
  correct(observation);
  return true;
}

/// Matches a new scan, each beam of it taken from where it was fired, and replaces the pose.
void MatchedRobot::correct(algo::Observation& observation) {
  const algo::Pose2 wheels = observation.odometry.pose;
  trail_.follow(wheels, observation.stamp);
  if (const algo::LaserScan* scan = algo::front_scan(observation)) {
    const algo::Pose2 robot_in_scanner = algo::pose_step(scan->mount_R, {});
    const algo::Pose2 scanned = algo::compose(trail_.map(*scan), robot_in_scanner);
    points_R_.clear();
    points_R_.reserve(scan->size());
    for (std::size_t i = 0; i < scan->size(); ++i) {
      if (scan->status[i] != algo::Beam::Ok) continue;
      points_R_.push_back(algo::to_child(scanned, trail_.points_W()[i]));
    }
    auto moved = odometry_.take(points_R_, scan->mount_R.position(), scanned);
    if (moved) observation.map_move = std::make_shared<const algo::MapMove>(*std::move(moved));
  }
  observation.odometry.pose = odometry_.pose_W(wheels);
}

}  // namespace server
