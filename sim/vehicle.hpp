// sim/vehicle.hpp: the moving part of a simulated robot.
#pragma once

#include <cstddef>

#include "algo/obstacle.hpp"
#include "algo/types.hpp"
#include "sim/obstacle_set.hpp"
#include "sim/pose_trail.hpp"
#include "sim/robot_model.hpp"

namespace sim {

/// What a vehicle does at the end of a tick.
struct VehicleState {
  algo::Pose2 pose_W{};
  algo::Twist2 twist{};   // of R, true
  double left_angle = 0;  // [rad] the wheels have turned since reset
  double right_angle = 0;
  bool contact = false;  // the hull touched an obstacle within the tick
  double roll = 0;       // [rad] left side up positive
  double pitch = 0;      // [rad] nose down positive
};

/// How a tick is cut into equal physics steps: at 240 Hz or a little faster.
struct Substeps {
  explicit Substeps(double period);
  std::size_t count = 1;
  double length = 0;  // [s]
};

/// `command` within the vehicle's limits: both parts scaled alike, so that the curvature is kept
/// (equations.md I). What is not a number counts as 0.
algo::Twist2 within_limits(const algo::Twist2& command, const RobotModel& vehicle);

/// `now` moved towards `wanted` as far as the acceleration limits allow in `dt` [s].
algo::Twist2 ramped(const algo::Twist2& now,
                    const algo::Twist2& wanted,
                    const RobotModel& vehicle,
                    double dt);

class VehicleModel {
 public:
  virtual ~VehicleModel() = default;
  VehicleModel(const VehicleModel&) = delete;
  VehicleModel& operator=(const VehicleModel&) = delete;

  /// At rest at `start`.
  virtual void reset(const algo::Pose2& start) = 0;
  /// Drives for one tick under `command` and notes the pose after each physics step in `trail`.
  virtual void drive(const algo::Twist2& command,
                     const ObstacleSet& obstacles,
                     PoseTrail& trail) = 0;
  /// Stops driving at once, without the ramp.
  virtual void halt() noexcept = 0;

  /// The obstacles as they change; `index` is the one in the ObstacleSet.
  virtual void added(const algo::Obstacle& /*obstacle*/) {}
  virtual void moved(std::size_t /*index*/, const algo::Obstacle& /*obstacle*/) {}
  virtual void removed(std::size_t /*index*/) {}

  virtual const VehicleState& state() const = 0;

 protected:
  VehicleModel() = default;
};

}  // namespace sim
