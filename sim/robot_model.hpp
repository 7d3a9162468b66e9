// sim/robot_model.hpp: the parameters of one robot: hull, mass, wheels, limits, sensors.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "algo/robot.hpp"
#include "algo/units.hpp"
#include "sim/arm_model.hpp"
#include "sim/obstacle_set.hpp"
#include "sim/sensor_configs.hpp"

namespace sim {

/// A free-rolling ball under the chassis.
struct Caster {
  double x = 0, y = 0;  // [m] in R
  double radius = 0;    // [m]
  double raised = 0;    // [m] height of its lowest point above the floor
  bool operator==(const Caster&) const = default;
};

/// A base with two driven sides (physics.md 3). R lies on the floor under the centre of the hull,
/// which is also the centre of mass. The defaults are the Silvermate's.
struct Machine {
  std::string name = "silvermate";  // [a-z0-9_-]+, at most 64
  bool round = true;                // the hull is a cylinder of `radius`; otherwise a box
  double radius = 0.35;             // [m] of the circle about R that encloses the hull in the plane
  double hull_length = 0.70, hull_width = 0.70;  // [m] if round, the diameter
  double hull_low = 0.06, hull_high = 0.46;      // [m] above the floor
  double mass = 60;                              // [kg]
  double mass_height = 0.25;                     // [m] of the centre of mass
  double half_track = 0.25;                      // [m]
  double wheel_radius = 0.10;                    // [m]
  std::vector<double> wheels{0};                 // [m] x of the wheels on each side
  std::vector<Caster> casters{{0.27, 0, 0.04, 0.001}, {-0.27, 0, 0.04, 0.001}};
  double max_v = 0.5;                   // [m/s]
  double max_omega = 1.0;               // [rad/s]
  double max_acceleration = 0.5;        // [m/s2]
  double max_angular_acceleration = 4;  // [rad/s2]
  double max_jerk = 0;                  // [m/s3] for its controller; 0: no limit
  double max_angular_jerk = 0;          // [rad/s3]
  double friction = 0.8;                // of the drive wheels on the floor
  double counts_per_turn = 40000;       // of a wheel's encoder
  /// If they were measured (`tautline climbs`).
  std::optional<algo::ClimbLimits> climbs =
      algo::ClimbLimits{0.003, 0.058, 0.270, 0, 42 * algo::units::kRadiansPerDegree};

  std::optional<ArmModel> arm{};

  /// Makes the hull a box; `radius` becomes that of the circle through its corners.
  void set_box(double length, double width);
  void set_disc(double radius_m);
  bool operator==(const Machine&) const = default;
};

struct RobotModel : Machine {
  Sensors sensors{};
  bool operator==(const RobotModel&) const = delete;  // sensors do not compare: use Machine
};

constexpr std::size_t kMostWheels = 8;  // per side
constexpr std::size_t kMostCasters = 8;

/// A defect of the combination of numbers, as in "casters: without them the robot would tip over";
/// begins with the field. Each number must already be within its own limits.
std::optional<std::string> defect(const RobotModel& robot);

/// The port's spec of the robot, with ticks of `period` [s] and `drives` false. It has a stance if
/// the robot has an inclinometer of its own.
algo::RobotSpec spec_of(const RobotModel& robot, double period);

/// What the robot stands on: the width between its tracks, and twice the distance from R to the
/// nearer one of its foremost and hindmost supports.
algo::Stance stance_of(const RobotModel& robot);

/// [m] x of the drive axle in R: the middle of the wheels.
double axle_of(const RobotModel& robot);

/// The outline in the plane.
Hull hull_of(const RobotModel& robot);

}  // namespace sim
