// sim/vehicle.hpp: the base of a simulated robot.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>

#include "algo/arm_spec.hpp"
#include "algo/obstacle.hpp"
#include "algo/robot.hpp"
#include "algo/types.hpp"
#include "sim/obstacle_set.hpp"
#include "sim/pose_trail.hpp"
#include "sim/robot_model.hpp"

namespace sim {

/// The joints of a robot's arm at the end of a tick.
struct ArmState {
  algo::JointValues position{};             // [rad]
  algo::JointValues rate{};                 // [rad/s] mean in the tick
  std::optional<algo::BodyLink> touched{};  // in this tick, by something or by another part
};

/// The state of a vehicle at the end of a tick.
struct VehicleState {
  algo::Pose2 pose_W{};
  algo::Twist2 twist{};   // of R, true
  double left_angle = 0;  // [rad] turned by the wheels since reset
  double right_angle = 0;
  bool contact = false;  // the hull touched an obstacle in this tick
  double roll = 0;       // [rad] left side up positive
  double pitch = 0;      // [rad] nose down positive
  double z = 0;          // [m] of R above z = 0
  bool fallen = false;   // since reset, a wheel or caster came down an edge too high for the robot
  /// [rad] Bearing in R of the newest contact with the upright end of a ramp or trench, in this
  /// tick.
  std::optional<double> ground_contact{};
  ArmState arm{};       // of a robot with an arm
  bool scrape = false;  // the hull touched the ground or an obstacle, in whatever direction
  algo::Tilt tilt() const { return {z, roll, pitch}; }
  bool overturned() const { return algo::is_overturned(roll, pitch); }
};

/// Divides a tick into equal physics steps, at `rate` or slightly faster.
struct Substeps {
  static constexpr double kRate = 240;  // [Hz]
  explicit Substeps(double period, double rate = kRate);
  std::size_t count = 1;
  double length = 0;  // [s]
};

/// `command` within the vehicle's limits. Both components are scaled alike, which keeps the
/// curvature (equations.md I). NaN counts as 0.
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

  /// Places the vehicle at rest at `start`.
  virtual void reset(const algo::Pose2& start) = 0;
  /// Sets the vehicle, at rest since reset(), on the ramps and trenches under it.
  virtual void stand_on(const ObstacleSet& /*ground*/) {}
  /// Drives for one tick under `command` and records the pose after each physics step in `trail`.
  virtual void drive(const algo::Twist2& command,
                     const ObstacleSet& obstacles,
                     PoseTrail& trail) = 0;
  /// Turns the joints of the robot's arm at `rates` [rad/s], within their limits, from the next
  /// drive() on.
  virtual void turn_joints(const algo::JointValues& /*rates*/) {}
  /// Stops driving at once, without the ramp. A vehicle that would turn over by that only stops
  /// wanting to drive: it brakes by its ramp.
  virtual void halt() noexcept = 0;

  /// Changes of the obstacles; `index` is the index in the ObstacleSet.
  virtual void added(const algo::Obstacle& /*obstacle*/) {}
  virtual void moved(std::size_t /*index*/, const algo::Obstacle& /*obstacle*/) {}
  virtual void removed(std::size_t /*index*/) {}

  virtual const VehicleState& state() const = 0;

 protected:
  VehicleModel() = default;
};

}  // namespace sim
