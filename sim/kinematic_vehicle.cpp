// sim/kinematic_vehicle.cpp: exact arcs, one distance query per tick.
#include "sim/kinematic_vehicle.hpp"

#include "algo/diff_drive.hpp"

namespace sim {

KinematicVehicle::KinematicVehicle(const RobotModel& robot, double period, bool with_ramps)
    : robot_(robot),
      hull_(hull_of(robot)),
      period_(period),
      substeps_(period),
      axle_(axle_of(robot)),
      with_ramps_(with_ramps) {}

void KinematicVehicle::reset(const algo::Pose2& start) {
  state_ = {};
  state_.pose_W = start;
  target_ = {};
}

void KinematicVehicle::drive(const algo::Twist2& command,
                             const ObstacleSet& obstacles,
                             PoseTrail& trail) {
  const algo::Twist2 wanted = within_limits(command, robot_);
  target_ = with_ramps_ ? ramped(target_, wanted, robot_, period_) : wanted;
  const algo::Pose2 from = state_.pose_W;
  algo::Twist2 twist = target_;
  algo::Pose2 to = algo::integrate_arc(from, twist, period_, axle_);
  state_.contact = false;
  // A robot that already overlaps an obstacle may leave it. A rectangle may leave in any direction,
  // since the depth of its overlap is unknown.
  const double clearance = obstacles.clearance(hull_, to);
  const auto was_clear = [&] {
    return obstacles.clearance(hull_, from) > (robot_.round ? clearance : 0);
  };
  if (clearance < 0 && was_clear()) {
    state_.contact = true;
    twist.v = 0;
    target_.v = 0;
    to = algo::integrate_arc(from, twist, period_, axle_);
  }
  for (std::size_t k = 1; k < substeps_.count; ++k) {
    trail.push(algo::integrate_arc(from, twist, static_cast<double>(k) * substeps_.length, axle_));
  }
  trail.push(to);
  state_.pose_W = to;
  state_.twist = twist;
  const algo::WheelSpeeds speeds =
      algo::inverse_kinematics({robot_.wheel_radius, robot_.half_track}, twist);
  state_.left_angle += speeds.left * period_;
  state_.right_angle += speeds.right * period_;
}

}  // namespace sim
