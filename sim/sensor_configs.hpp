// sim/sensor_configs.hpp: the sensors of a simulated robot as plain values.
#pragma once

#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "algo/ground_sense.hpp"
#include "algo/types.hpp"

namespace sim {

enum class LaserUnit : std::uint8_t { Millimetre, Centimetre };
enum class NoiseShape : std::uint8_t { Gaussian, Uniform };

/// The LMS200 model (physics.md 6). Every imperfection can be switched off, down to ideal().
struct LaserConfig {
  algo::Pose2 mount_R{};
  double height = 0.30;        // [m] of the scan plane
  double field_of_view = 0;    // [rad] pi, or 100 deg at 0.25 deg on an LMS200
  double angle_increment = 0;  // [rad]
  std::uint32_t turns = 1;     // interlaced mirror turns in a sweep
  bool rolling = true;         // beams fired one by one; false: all from the pose at the tick
  double mirror_period = 1.0 / 75.0;  // [s] one turn
  LaserUnit unit = LaserUnit::Millimetre;
  double range_max = 8.191;  // [m] 81.91 in centimetre mode
  double bias = 0.015;       // [m] uniform in +-bias, drawn once per run
  double noise = 0.005;      // [m] standard deviation, or half width if Uniform
  NoiseShape noise_shape = NoiseShape::Gaussian;
  bool mixed_pixels = true;
  bool reflectivity = true;  // range drops with the surface's reflectivity; specular surfaces
  double dropout = 0.002;    // probability of a no-echo code per beam
  double salt = 0;           // probability of maximum range per beam
  double pepper = 0;         // probability of a false near reading per beam

  /// 1, 0.5 or 0.25 degree; throws std::invalid_argument for any other.
  static LaserConfig with_resolution(double degrees);
  /// A scanner without scan time or noise: fires every beam from the pose at the tick.
  static LaserConfig ideal(double degrees);
  /// A scanner of another make, without scan time: `beams` over `field_of_view` [rad], Gaussian
  /// noise only.
  static LaserConfig flat(double field_of_view, std::uint32_t beams, double range_max);
};

/// A ring of sonars (sensors.md 3), spaced evenly over `field` on the hull; they ping in turn.
struct SonarConfig {
  std::uint32_t count = 12;
  double field = 2 * std::numbers::pi;      // [rad] that the axes span
  double cone = std::numbers::pi / 6;       // [rad] whole beam
  double ping = 0.04;                       // [s] between the pings of neighbouring sensors
  double range_min = 0.15;                  // [m] nearer obstacles read as this
  double range_max = 5.0;                   // [m] Free if nothing is within it
  double noise = 0.01;                      // [m] standard deviation
  double incidence = std::numbers::pi / 3;  // [rad] more oblique surfaces give no echo
  bool crosstalk = false;  // a late echo of the neighbour's ping before counts as an own one
  double height = 0.30;    // [m] of the ring
};

/// An infrared range scanner with the figures of the PBS-03JN (sensors.md 2): a fan of narrow beams
/// low on the hull, for obstacles under the laser's plane.
struct InfraredConfig {
  algo::Pose2 mount_R{};
  double height = 0.10;                         // [m] of the fan
  std::uint32_t beams = 121;                    // over the field
  double field = 212 * std::numbers::pi / 180;  // [rad] about the mount's heading
  double period = 0.18;                         // [s] between scans
  double range_min = 0.10;                      // [m] nearer obstacles read as this
  double range_max = 3.5;                       // [m] Free if nothing is within it
  double noise = 0.02;                          // [m] standard deviation
};

/// A yaw gyro (sensors.md 4): rate = true + bias + noise; the bias is a random walk.
struct GyroConfig {
  double bias = 0;       // [rad/s] standard deviation of the initial bias
  double bias_walk = 0;  // [rad/s] standard deviation of its drift in one second
  double noise = 0;      // [rad/s] standard deviation of a reading
};

/// A laser's line on the ground ahead and its camera. The defaults are errors only.
struct LineCameraConfig : algo::LineCamera {
  double noise = 0.5;     // [pixels] standard deviation of v, before it becomes whole
  double dropout = 0.02;  // probability that a column's pixel is missing
  double period = 0.05;   // [s] between images
};

/// An inclinometer for roll and pitch. A robot that has one may turn over: its pipeline then keeps
/// it from that (RobotSpec::stance).
struct InclinometerConfig {
  double noise = 0.2 * std::numbers::pi / 180;  // [rad] standard deviation
  double lag = 0.05;                            // [s] time constant of its first-order answer
  double period = 0;                            // [s] between readings; 0: every tick
};

/// Four Sharp GP2D12 that look down at the floor ahead (sensors.md 7, equations.md H).
struct FloorSensorConfig {
  double x = 0.14;                      // [m] in R, of the near sensors
  double height = 0.14142136;           // [m] above the floor, of the near sensors
  double half_spacing = 0.10;           // [m] from R's x axis to either side
  double angle = std::numbers::pi / 4;  // [rad] of the beams, down from R's x axis
  double separation = 0.08;             // [m] between the two beams of a side, at right angles
  double noise = 0.006;                 // [V] standard deviation
  double spot = 0.004;                  // [m] height of the light spot, at right angles to the beam
  double glitches = 0.005;              // probability of a reading off by up to 10 cm
  double period = 0.038;                // [s] between new readings
  /// Noise grows by (cos 45 / cos incidence)^2: a calibration of ours on the spread of Tables
  /// I-III.
  bool grazing = false;
};

/// A sensor's setting in a scenario: a number or a list of numbers.
struct Setting {
  std::string name{};
  std::vector<double> values{};
};

/// A sensor in a scenario.
struct SensorConfig {
  std::string sensor{};   // the kind: a file of sim/sensors
  std::string channel{};  // its name in frames and exports: "battery.voltage"
  std::string unit{};     // of its values; empty: that of the kind
  std::vector<Setting> settings{};

  const std::vector<double>* find(std::string_view name) const;
  /// The value of a setting that is one number.
  double number(std::string_view name, double fallback) const;
};

/// All sensors of one robot.
struct Sensors {
  std::vector<LaserConfig> lasers{LaserConfig::with_resolution(0.5)};
  std::optional<SonarConfig> sonar{};
  std::vector<InfraredConfig> infrared{};
  std::optional<FloorSensorConfig> floor{};
  std::vector<SensorConfig> further{};  // each with a channel of its own
  /// Absent: an ideal gyro with dynamics, none without.
  std::optional<GyroConfig> gyro{};
  bool has_gyro = true;
  std::optional<LineCameraConfig> line_camera{};
  /// Absent: an ideal one with dynamics, none without.
  std::optional<InclinometerConfig> inclinometer{};
  std::uint32_t bumpers = 1;  // evenly around the hull from straight ahead, with equal sectors
  bool encoders = true;

  bool looks_ahead() const;  // a scanner
  /// False only if a sonar ring replaces the scanner, as none looks ahead.
  bool has_laser() const;
  /// True if the ring has a sonar for each axis that the laws for driving by hand read, and a round
  /// of its pings is short enough for them (algo/ring_axes.hpp).
  bool has_ring() const;
  /// [m] Height above the floor of the highest scanner, ring or fan.
  double height() const;
};

}  // namespace sim
