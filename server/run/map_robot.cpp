// server/run/map_robot.cpp: odometry and scans in, the pose on the map out.
#include "server/run/map_robot.hpp"

#include <cmath>
#include <utility>

#include "algo/perceive.hpp"
#include "server/run/drawn_map.hpp"
#include "server/run/map_file.hpp"

namespace server {
namespace {

constexpr double kJump = 0.3;      // [m] a correction after which what was seen lies elsewhere
constexpr double kJumpTurn = 0.1;  // [rad]

bool is_jump(const algo::Pose2& from_W, const algo::Pose2& to_W) {
  return (to_W.position() - from_W.position()).norm() > kJump ||
         std::abs(algo::wrap_angle(to_W.heading - from_W.heading)) > kJumpTurn;
}

}  // namespace

std::shared_ptr<const KnownMap> known_map(const std::filesystem::path& yaml) {
  const algo::OccupancyMap cells = read_map(yaml);
  const std::string name = yaml.filename().string();
  return std::make_shared<const KnownMap>(
      KnownMap{std::filesystem::absolute(yaml).string(),
               name,
               seen_walls(cells),
               map_document(cells, name),
               std::make_shared<const algo::DrawnSpace>(drawn_space(cells))});
}

MapRobot::MapRobot(std::shared_ptr<algo::Robot> robot,
                   const KnownMap& map,
                   const std::optional<algo::Pose2>& start_W,
                   Waits waits)
    : ForwardingRobot(std::move(robot)), localizer_(map.walls), start_W_(start_W), waits_(waits) {}

void MapRobot::reset(algo::Observation& observation) {
  ForwardingRobot::reset(observation);
  localizer_.restart();
  if (start_W_) localizer_.start(*start_W_);
  trail_.reset();
  scanned_.reset();
  located_ = false;
  epoch_ = 0;
  wheels_ = observation.odometry.pose;
  pose_W_ = start_W_.value_or(wheels_);
  locate(observation);
}

bool MapRobot::step(const algo::Command& command, algo::Observation& observation) {
  if (!ForwardingRobot::step(command, observation)) return false;
  locate(observation);
  return true;
}

void MapRobot::place(const algo::SetInitialPose& at) {
  if (at.pose_W) {
    localizer_.place(*at.pose_W);
    pose_W_ = *at.pose_W;
  } else {
    localizer_.forget();
  }
  located_ = false;
}

void MapRobot::locate(algo::Observation& observation) {
  trail_.follow(observation.odometry.pose, observation.stamp);
  if (const algo::LaserScan* scan = algo::front_scan(observation)) {
    const algo::Pose2 robot_in_scanner = algo::pose_step(scan->mount_R, {});
    scanned_ = algo::compose(trail_.map(*scan), robot_in_scanner);
    if (waits_ == Waits::Yes) {
      localizer_.take(*scan, *scanned_);
    } else {
      localizer_.take_whole(*scan, *scanned_);
    }
  }
  correct(observation);
}

/// Replaces the odometry's pose.
void MapRobot::correct(algo::Observation& observation) {
  const algo::Pose2 wheels = observation.odometry.pose;
  const bool located = localizer_.located();
  const algo::Pose2 predicted_W = algo::compose(pose_W_, algo::pose_step(wheels_, wheels));
  if (located) {
    pose_W_ = algo::compose(localizer_.best().pose_M(), algo::pose_step(*scanned_, wheels));
    if (!located_ || is_jump(predicted_W, pose_W_)) ++epoch_;
  } else {
    pose_W_ = predicted_W;
  }
  located_ = located;
  wheels_ = wheels;
  observation.odometry.pose = pose_W_;
  algo::MapPose& told = observation.map_pose.emplace();
  told.fix = localizer_.fix();
  told.places = static_cast<std::uint32_t>(localizer_.places());
  told.epoch = epoch_;
  told.wheels = wheels;
  if (localizer_.places() == 0) return;
  const Eigen::Matrix3d covariance = localizer_.best().covariance();
  told.xx = covariance(0, 0);
  told.xy = covariance(0, 1);
  told.yy = covariance(1, 1);
  told.turn = covariance(2, 2);
  told.fit = localizer_.best().fit();
}

}  // namespace server
