// sim/scenario.hpp: a world for a run as plain values: robot, start, goal, obstacles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "algo/obstacle.hpp"
#include "algo/parameters.hpp"
#include "algo/request.hpp"
#include "algo/types.hpp"
#include "sim/robot_model.hpp"

namespace sim {

/// Bullet moves the robot by forces and contacts; Kinematic moves it as commanded, within its
/// limits.
enum class PhysicsKind : std::uint8_t { Bullet, Kinematic };

/// Deviations of a simulated base from the robot's table, from its commands, and from its reports.
/// The odometry's drift is the residual of gyro and worn wheels: equations.md I.
struct DriveConfig {
  std::optional<double> max_v{};                     // [m/s] instead of the robot's own
  std::optional<double> max_omega{};                 // [rad/s]
  std::optional<double> max_acceleration{};          // [m/s2]
  std::optional<double> max_angular_acceleration{};  // [rad/s2]
  bool ramps = false;             // the kinematic vehicle obeys its acceleration limits too
  std::uint32_t delay_ticks = 0;  // until a command acts
  double yaw_slip = 0;            // share of each turn lost to slip on the floor
  double odometry_scale = 0;  // error of distances and of angles, each with random sign: 0.02 = 2 %
  double odometry_noise = 0;  // standard deviation of both per metre and per radian, relative
  double odometry_slip = 0;   // share lost to slip of each turn that the wheels count
  bool operator==(const DriveConfig&) const = default;
};

/// The source of the odometry.
enum class Localization : std::uint8_t {
  Encoders,  // the wheels alone
  Gyro,      // distances from the wheels, turns from the gyro (algo/local_localization.hpp)
};

/// Another robot in a scenario's world, driven by its own pipeline. It has the scenario's drive.
/// Absent fields are those of the scenario's first robot.
struct OtherRobot {
  algo::Pose2 start{};
  std::optional<RobotModel> robot{};
  /// Waypoints and goal, in order; empty: it stands still.
  std::optional<std::vector<algo::SetGoal>> goals{};
  std::optional<std::string> controller{};
  std::optional<std::string> filter{};
  std::vector<algo::Parameters::Setting> parameters{};  // replace the scenario's
};
constexpr std::size_t kMostRobots = 200;  // in one world
/// Ids of robots as obstacles: robot n, counted from 1, has kRobotIds + n. Obstacles that people
/// add have lower ids.
constexpr std::uint32_t kRobotIds = 1'000'000'000;

struct Scenario {
  std::string name{};  // [a-z0-9_-]+, at most 64
  std::string title{};
  std::string description{};
  RobotModel robot{};
  PhysicsKind physics = PhysicsKind::Bullet;
  double period = 0.026;  // [s] one tick
  algo::Pose2 start{};
  std::optional<algo::SetGoal> goal{};
  std::vector<algo::SetGoal> waypoints{};  // on the way to the goal, in order
  bool loop = false;  // a live robot drives the way without end; without waypoints, to and fro
  std::optional<algo::SetHandGoal> hand_goal{};  // of a robot with an arm, instead of the goal
  bool carry = false;                            // to the goal with the arm as it is
  std::optional<algo::JointValues> joints{};     // [rad] at the start; absent: at rest
  DriveConfig drive{};
  std::vector<algo::Obstacle> obstacles{};
  std::vector<OtherRobot> robots{};  // besides the first, which the other fields describe
  Localization localization = Localization::Encoders;
  std::string controller = "modified";
  std::string filter = "pseudomedian";
  algo::Parameters parameters{};
  double time_limit = 0;  // [s] run clock for headless runs; 0 = 5 x straight line / v_max
  std::string log{};      // path of a CARMEN log to replay instead of a world
  std::string map{};      // path of a map of map_server that the robot knows; empty: none
  bool lost = false;      // where it begins on that map is not known to it

  /// [m] Where the run is to end on the map: the base's goal, or the place below the hand's.
  std::optional<algo::Vec2> end_W() const {
    if (goal) return goal->position_W;
    if (!hand_goal) return std::nullopt;
    if (hand_goal->then) return hand_goal->then->position_W;
    const algo::Vec3& hand_W =
        hand_goal->path_W.empty() ? hand_goal->position_W : hand_goal->path_W.back();
    return hand_W.head<2>();
  }
};

}  // namespace sim
