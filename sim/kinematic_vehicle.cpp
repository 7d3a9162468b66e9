// sim/kinematic_vehicle.cpp: exact arcs, one distance query per tick.
#include "sim/kinematic_vehicle.hpp"

#include <algorithm>

#include "algo/diff_drive.hpp"

namespace sim {

KinematicVehicle::KinematicVehicle(const RobotModel& robot, double period, bool with_ramps)
    : robot_(robot),
      hull_(hull_of(robot)),
      period_(period),
      substeps_(period),
      axle_(axle_of(robot)),
      with_ramps_(with_ramps) {
  if (robot.arm) reach_.emplace(robot);
}

void KinematicVehicle::reset(const algo::Pose2& start) {
  state_ = {};
  state_.pose_W = start;
  target_ = {};
  joint_rates_ = {};
  if (robot_.arm) state_.arm.position = robot_.arm->begins();
}

algo::Pose2 KinematicVehicle::move_arm(const algo::Pose2& from,
                                       const algo::Pose2& to,
                                       const ObstacleSet& obstacles) {
  const algo::JointValues rates =
      within_limits(joint_rates_, state_.arm.position, *robot_.arm, period_);
  const algo::ArmJoints stays = algo::joints_of(state_.arm.position);
  const algo::ArmJoints turned = stays + period_ * algo::joints_of(rates);
  const auto at = [&](const algo::Pose2& base, const algo::ArmJoints& q) {
    return reach_->nearest(algo::body_joints(base, q), obstacles);
  };
  const double least = std::min(0.0, at(from, stays).distance);
  state_.arm.touched.reset();
  state_.arm.rate = {};
  struct Motion {
    const algo::Pose2& base;
    const algo::ArmJoints& q;
  };
  for (const Motion& motion : {Motion{to, turned}, Motion{to, stays}, Motion{from, turned}}) {
    const NearestPart there = at(motion.base, motion.q);
    if (there.distance < least) {
      state_.arm.touched = there.link;
      continue;
    }
    state_.arm.position = algo::values_of(motion.q);
    if (&motion.q == &turned) state_.arm.rate = rates;
    return motion.base;
  }
  return from;
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
  if (reach_) {
    const algo::Pose2 moved = move_arm(from, to, obstacles);
    if (moved != to) {
      to = moved;
      twist = {};
      target_ = {};
    }
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
