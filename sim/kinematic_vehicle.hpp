// sim/kinematic_vehicle.hpp: a vehicle without dynamics, for speed and for the papers' conditions.
#pragma once

#include <optional>

#include "sim/arm_reach.hpp"
#include "sim/vehicle.hpp"

namespace sim {

/// Drives the exact arc of its command. It refuses to move into an obstacle and turns in place
/// instead.
class KinematicVehicle final : public VehicleModel {
 public:
  /// `with_ramps`: applies the acceleration limits, which the papers do not have.
  KinematicVehicle(const RobotModel& robot, double period, bool with_ramps = false);

  void reset(const algo::Pose2& start) override;
  void drive(const algo::Twist2& command, const ObstacleSet& obstacles, PoseTrail& trail) override;
  void turn_joints(const algo::JointValues& rates) override { joint_rates_ = rates; }
  void halt() noexcept override {
    target_ = {};
    joint_rates_ = {};
  }
  const VehicleState& state() const override { return state_; }

 private:
  /// The motion of base and arm that touches nothing more than before: the whole one, or that of
  /// the base or of the arm alone.
  algo::Pose2 move_arm(const algo::Pose2& from,
                       const algo::Pose2& to,
                       const ObstacleSet& obstacles);

  RobotModel robot_{};
  Hull hull_{};
  double period_ = 0;  // [s]
  Substeps substeps_;
  double axle_ = 0;  // [m] x of the drive axle in R
  bool with_ramps_ = false;
  algo::Twist2 target_{};
  std::optional<ArmReach> reach_{};  // of a robot with an arm
  algo::JointValues joint_rates_{};
  VehicleState state_{};
};

}  // namespace sim
