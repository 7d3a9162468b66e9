// sim/kinematic_vehicle.hpp: a vehicle without dynamics, for speed and for the papers' conditions.
#pragma once

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
  void halt() noexcept override { target_ = {}; }
  const VehicleState& state() const override { return state_; }

 private:
  RobotModel robot_{};
  Hull hull_{};
  double period_ = 0;  // [s]
  Substeps substeps_;
  double axle_ = 0;  // [m] x of the drive axle in R
  bool with_ramps_ = false;
  algo::Twist2 target_{};
  VehicleState state_{};
};

}  // namespace sim
