// sim/arm_reach.hpp: how near the true arm is to the obstacles and to its own robot.
#pragma once

#include <limits>
#include <vector>

#include "algo/arm/mobile_arm.hpp"
#include "algo/arm/solid.hpp"
#include "sim/obstacle_set.hpp"
#include "sim/robot_model.hpp"
#include "sim/vehicle.hpp"

namespace sim {

/// The part of mast and arm that is nearest to something.
struct NearestPart {
  double distance = std::numeric_limits<double>::infinity();  // [m] below 0: they overlap
  algo::BodyLink link = algo::BodyLink::Hand;
};

/// For a robot with an arm. Keeps its buffers.
class ArmReach {
 public:
  explicit ArmReach(const RobotModel& robot);

  /// To all of `obstacles` within reach, and to the robot itself where they overlap. The robot
  /// counts as standing upright.
  NearestPart nearest(const algo::BodyJoints& q, const ObstacleSet& obstacles) const;
  NearestPart nearest(const VehicleState& state, const ObstacleSet& obstacles) const;

 private:
  algo::MobileArm body_;
  double reach_ = 0;  // [m] from R
  mutable std::vector<algo::Solid> near_{};
};

/// `rates` within the limits of `arm`, for joints at `position` that turn for `dt` [s].
algo::JointValues within_limits(const algo::JointValues& rates,
                                const algo::JointValues& position,
                                const ArmModel& arm,
                                double dt);

}  // namespace sim
