// sim/robot_model.hpp: one robot as numbers: hull, mass, wheels, limits, sensors.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "algo/robot.hpp"
#include "sim/obstacle_set.hpp"
#include "sim/sensor_configs.hpp"

namespace sim {

/// A ball under the chassis that rolls freely.
struct Caster {
  double x = 0, y = 0;  // [m] in R
  double radius = 0;    // [m]
  double raised = 0;    // [m] its lowest point over the floor
  bool operator==(const Caster&) const = default;
};

/// A base with two driven sides (physics.md 3). R lies on the floor under the middle of the hull,
/// which is also that of the mass. The numbers here are the Silvermate's.
struct Machine {
  std::string name = "silvermate";  // [a-z0-9_-]+, at most 64
  bool round = true;                // the hull is a cylinder of `radius`, otherwise a box
  double radius = 0.35;             // [m] of the circle about R that encloses the hull in the plane
  double hull_length = 0.70, hull_width = 0.70;  // [m] of a round one: its diameter
  double hull_low = 0.06, hull_high = 0.46;      // [m] over the floor
  double mass = 60;                              // [kg]
  double mass_height = 0.25;                     // [m] of the centre of mass
  double half_track = 0.25;                      // [m]
  double wheel_radius = 0.10;                    // [m]
  std::vector<double> wheels{0};                 // [m] x of the wheels of each side
  std::vector<Caster> casters{{0.27, 0, 0.04, 0.001}, {-0.27, 0, 0.04, 0.001}};
  double max_v = 0.5;                   // [m/s]
  double max_omega = 1.0;               // [rad/s]
  double max_acceleration = 0.5;        // [m/s2]
  double max_angular_acceleration = 4;  // [rad/s2]
  double friction = 0.8;                // of the drive wheels on the floor
  double counts_per_turn = 40000;       // of a wheel's encoder

  /// A box; `radius` is that of the circle about its corners.
  void set_box(double length, double width);
  void set_disc(double radius_m);
  bool operator==(const Machine&) const = default;
};

struct RobotModel : Machine {
  Sensors sensors{};
  bool operator==(const RobotModel&) const = delete;  // sensors do not compare: compare machines
};

constexpr std::size_t kMostWheels = 8;  // of a side
constexpr std::size_t kMostCasters = 8;

/// What is wrong with the numbers together, as "casters: without them the robot would tip over";
/// begins with the field. Each number is within its own limits already.
std::optional<std::string> defect(const RobotModel& robot);

/// What the port says of it, in ticks of `period` [s]; one that does not drive.
algo::RobotSpec spec_of(const RobotModel& robot, double period);

/// The outline in the plane.
Hull hull_of(const RobotModel& robot);

}  // namespace sim
