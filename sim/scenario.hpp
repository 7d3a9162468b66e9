// sim/scenario.hpp: a world to run in, as plain values: robot, start, goal, obstacles, sensors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "algo/obstacle.hpp"
#include "algo/parameters.hpp"
#include "algo/request.hpp"
#include "algo/types.hpp"
#include "sim/sensor.hpp"

namespace sim {

enum class Vehicle : std::uint8_t { Bullet, Kinematic };
enum class LaserUnit : std::uint8_t { Millimetre, Centimetre };
enum class NoiseShape : std::uint8_t { Gaussian, Uniform };

/// The LMS200 model (physics.md 6). Every imperfection can be switched off, down to ideal().
struct LaserConfig {
  algo::Pose2 mount_R{};
  double height = 0.30;        // [m] of the scan plane
  double field_of_view = 0;    // [rad] pi, or 100 deg at 0.25 deg on an LMS200
  double angle_increment = 0;  // [rad]
  std::uint32_t turns = 1;     // interlaced mirror turns in a sweep
  bool rolling = true;         // beams fired one by one; false: all from one pose at the tick
  double mirror_period = 1.0 / 75.0;  // [s] one turn
  LaserUnit unit = LaserUnit::Millimetre;
  double range_max = 8.191;  // [m] 81.91 in centimetre mode
  double bias = 0.015;       // [m] uniform in +-bias, drawn once a run
  double noise = 0.005;      // [m] standard deviation, or half width when Uniform
  NoiseShape noise_shape = NoiseShape::Gaussian;
  bool mixed_pixels = true;
  bool reflectivity = true;  // range falls with the surface's reflectivity; specular surfaces
  double dropout = 0.002;    // probability of a no-echo code per beam
  double salt = 0;           // probability of maximum range per beam
  double pepper = 0;         // probability of a false near reading per beam

  /// 1, 0.5 or 0.25 degree; throws std::invalid_argument on another.
  static LaserConfig with_resolution(double degrees);
  /// Flat-time, noise-free: every beam from the pose at the tick.
  static LaserConfig ideal(double degrees);
  /// A scanner of another make, flat-time: `beams` over `field_of_view` [rad], Gaussian noise only.
  static LaserConfig flat(double field_of_view, std::uint32_t beams, double range_max);
};

/// How a simulated base departs from the robot's table, from what it is told, and from what it
/// reports. The odometry drifts by what a gyro and worn wheels leave over: equations.md I.
struct DriveConfig {
  std::optional<double> max_v{};                     // [m/s] instead of the robot's own
  std::optional<double> max_omega{};                 // [rad/s]
  std::optional<double> max_acceleration{};          // [m/s2]
  std::optional<double> max_angular_acceleration{};  // [rad/s2]
  bool ramps = false;             // the kinematic vehicle heeds its acceleration limits too
  std::uint32_t delay_ticks = 0;  // until a command acts
  double yaw_slip = 0;            // share of each turn that is lost on the floor
  double odometry_scale = 0;  // error of distances and of angles, each of random sign: 0.02 = 2 %
  double odometry_noise = 0;  // standard deviation of both per metre and per radian, relative
  double odometry_slip = 0;   // share of each turn of the wheels that the floor did not follow
  bool operator==(const DriveConfig&) const = default;
};

/// The way of an obstacle that moves by itself: linear between keys, over and over; from the last
/// key it jumps to the first.
struct ObstaclePath {
  struct Key {
    double time = 0;  // [s] of the path, ascending
    algo::Vec2 position_W{0, 0};
  };
  std::uint32_t id = 0;  // of the obstacle
  double period = 0;     // [s] above 0
  double phase = 0;      // [s] of the path when the run begins
  std::vector<Key> keys{};

  /// Where its obstacle is at `stamp` [s, run clock].
  algo::Vec2 at(double stamp) const;
};

/// A ring of sonars (sensors.md 3), evenly over `field` on the hull, pinging in turn.
struct SonarConfig {
  std::uint32_t count = 12;
  double field = 2 * std::numbers::pi;      // [rad] that the axes are spread over
  double cone = std::numbers::pi / 6;       // [rad] whole beam
  double ping = 0.04;                       // [s] from one sensor's ping to the next one's
  double range_min = 0.15;                  // [m] nearer things read as that
  double range_max = 5.0;                   // [m] nothing within it: Free
  double noise = 0.01;                      // [m] standard deviation
  double incidence = std::numbers::pi / 3;  // [rad] a surface met more obliquely gives no echo
  double height = 0.30;                     // [m] of the ring
};

/// An infrared range scanner, by the figures of the PBS-03JN (sensors.md 2): a fan of narrow beams,
/// low on the hull, where it meets what lies under the laser's plane.
struct InfraredConfig {
  algo::Pose2 mount_R{};
  double height = 0.10;                         // [m] of the fan
  std::uint32_t beams = 121;                    // over the field
  double field = 212 * std::numbers::pi / 180;  // [rad] about the mount's heading
  double period = 0.18;                         // [s] from one scan to the next
  double range_min = 0.10;                      // [m] nearer things read as that
  double range_max = 3.5;                       // [m] nothing within it: Free
  double noise = 0.02;                          // [m] standard deviation
};

/// A yaw gyro (sensors.md 4): rate = true + bias + noise, the bias on a random walk.
struct GyroConfig {
  double bias = 0;       // [rad/s] standard deviation of the bias a run begins with
  double bias_walk = 0;  // [rad/s] that it wanders off in a second, standard deviation
  double noise = 0;      // [rad/s] standard deviation of a reading
};

/// What the odometry is made of.
enum class Localization : std::uint8_t {
  Encoders,  // the wheels alone
  Gyro,      // distances from the wheels, turns from the gyro (algo/local_localization.hpp)
};

/// Another robot in the world of a scenario, by its own pipeline on its way. It has the scenario's
/// sensors and drive. What is absent is as the scenario's first robot has it.
struct OtherRobot {
  algo::Pose2 start{};
  std::optional<std::string> robot{};
  /// Waypoints and goal, in order; empty: it stands where it is.
  std::optional<std::vector<algo::SetGoal>> goals{};
  std::optional<std::string> controller{};
  std::optional<std::string> filter{};
  std::vector<algo::Parameters::Setting> parameters{};  // in place of the scenario's
};
constexpr std::size_t kMostRobots = 200;  // in one world
/// Ids of robots as obstacles: robot n, counted from 1, has kRobotIds + n. No obstacle that a
/// person adds has one so high.
constexpr std::uint32_t kRobotIds = 1'000'000'000;

struct Scenario {
  std::string name{};  // [a-z0-9_-]+, at most 64
  std::string title{};
  std::string description{};
  std::string robot = "silvermate";
  Vehicle vehicle = Vehicle::Bullet;
  double period = 0.026;  // [s] one tick
  algo::Pose2 start{};
  std::optional<algo::SetGoal> goal{};
  std::vector<algo::SetGoal> waypoints{};  // on the way to the goal, in order
  DriveConfig drive{};
  std::vector<algo::Obstacle> obstacles{};
  std::vector<ObstaclePath> paths{};  // of obstacles that move by themselves
  std::vector<OtherRobot> robots{};   // besides the first, which all else here is about
  std::vector<LaserConfig> lasers{LaserConfig::with_resolution(0.5)};
  std::optional<SonarConfig> sonar{};
  std::vector<InfraredConfig> infrared{};
  std::vector<SensorConfig> sensors{};  // further ones, each with a channel of its own
  /// Absent: an ideal one with dynamics, none without.
  std::optional<GyroConfig> gyro{};
  bool has_gyro = true;
  std::uint32_t bumpers = 1;  // evenly round the hull from straight ahead, each its share of it
  bool encoders = true;
  Localization localization = Localization::Encoders;
  std::string controller = "modified";
  std::string filter = "pseudomedian";
  algo::Parameters parameters{};
  double time_limit = 0;  // [s] run clock for headless runs; 0 = 5 x straight line / v_max
  std::string log{};      // path of a CARMEN log to replay instead of a world
};

/// Whether a scanner looks ahead; with a sonar ring and none, the ring stands in for it.
bool has_laser(const Scenario& scenario);

}  // namespace sim
