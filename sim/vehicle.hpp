// sim/vehicle.hpp: the moving part of a simulated robot, and the robots there are.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "algo/obstacle.hpp"
#include "algo/types.hpp"
#include "sim/obstacle_set.hpp"
#include "sim/pose_trail.hpp"

namespace sim {

/// A ball under the chassis that rolls freely.
struct Caster {
  double x = 0, y = 0;  // [m] in R
  double radius = 0;    // [m]
  double raised = 0;    // [m] its lowest point over the floor
};

/// One robot as numbers; physics.md 3. R lies on the floor midway between the drive wheels.
struct VehicleParameters {
  std::string_view name{};
  double radius = 0;   // [m] of the circle about R that stands for the hull in the plane
  bool round = false;  // the hull is a cylinder of that radius, otherwise the box below
  double hull_length = 0, hull_width = 0;  // [m]
  double hull_low = 0, hull_high = 0;      // [m] over the floor
  double mass = 0;                         // [kg]
  double half_track = 0;                   // [m]
  double wheel_radius = 0;                 // [m] of the supports
  std::array<double, 2> support_x{};       // [m] of the supports on each side
  std::size_t supports = 0;                // of them in use
  std::array<Caster, 2> casters{};
  std::size_t caster_count = 0;
  double mass_height = 0;               // [m] of the centre of mass
  double max_v = 0;                     // [m/s]
  double max_omega = 0;                 // [rad/s]
  double max_acceleration = 0;          // [m/s2]
  double max_angular_acceleration = 0;  // [rad/s2]
  double friction = 0.8;                // of the drive wheels on the floor
  double counts_per_turn = 40000;       // of a wheel's encoder
};

/// All robots, and one by name.
std::span<const VehicleParameters> vehicle_table();
const VehicleParameters* find_vehicle(std::string_view name);
/// Throws std::invalid_argument with a sentence when there is none.
const VehicleParameters& vehicle_named(std::string_view name);

/// The outline of `vehicle` in the plane.
Hull hull_of(const VehicleParameters& vehicle);

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
algo::Twist2 within_limits(const algo::Twist2& command, const VehicleParameters& vehicle);

/// `now` moved towards `wanted` as far as the acceleration limits allow in `dt` [s].
algo::Twist2 ramped(const algo::Twist2& now,
                    const algo::Twist2& wanted,
                    const VehicleParameters& vehicle,
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
