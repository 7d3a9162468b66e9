// algo/observation.hpp: all sensor data of a robot at one instant. Fields of absent sensors are
// empty.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "algo/arm_spec.hpp"
#include "algo/laser_scan.hpp"
#include "algo/map_move.hpp"
#include "algo/map_pose.hpp"
#include "algo/recycled.hpp"
#include "algo/types.hpp"

namespace algo {

/// Pose integrated from the encoders, and the twist over the last period. A robot that knows a map
/// corrects the pose by its scans, see MapPose.
struct Odometry {
  double stamp = 0;  // [s] run clock
  Pose2 pose{};      // of R in W
  Twist2 twist{};
  bool operator==(const Odometry&) const = default;
};

/// One reading of a sonar or infrared ring.
struct RangeReading {
  Pose2 mount_R{};
  double stamp = 0;      // [s] run clock
  double range = 0;      // [m] meaningful only where status is Ok
  double range_max = 0;  // [m]
  Beam status = Beam::Free;
  bool operator==(const RangeReading&) const = default;
};

struct BumperReading {
  Pose2 mount_R{};  // middle of the contact zone
  double stamp = 0;
  bool pressed = false;
  bool operator==(const BumperReading&) const = default;
};

struct YawGyro {
  double stamp = 0;
  double rate = 0;  // [rad/s]
  bool operator==(const YawGyro&) const = default;
};

struct Inclinometer {
  double stamp = 0;
  double roll = 0;   // [rad] left side up positive
  double pitch = 0;  // [rad] nose down positive
  bool operator==(const Inclinometer&) const = default;
};

/// A point of the laser's line in the camera's image (algo/ground_sense.hpp).
struct LinePixel {
  float u = 0;  // [pixels] to the left of the middle
  float v = 0;  // [pixels] from the middle towards the laser
  bool operator==(const LinePixel&) const = default;
};

/// An image of the laser's line. Columns without a visible point are left out.
struct LineImage {
  double stamp = 0;    // [s] run clock
  bool fresh = false;  // came in this tick; otherwise `pixels` is empty
  Recycled<LinePixel> pixels{};
};

/// Distances along the four beams of FloorSensors; NaN where nothing is within range.
struct FloorRanges {
  double stamp = 0;       // [s] run clock
  double far_left = 0;    // [m] the paper's X1
  double far_right = 0;   // [m]
  double near_left = 0;   // [m] the paper's X2
  double near_right = 0;  // [m]
  bool operator==(const FloorRanges&) const = default;
};

/// Raw counts since reset. Take a difference modulo 2^32, as signed.
struct Encoders {
  double stamp = 0;
  std::uint32_t left = 0;
  std::uint32_t right = 0;
  bool operator==(const Encoders&) const = default;
};

/// Of an arm's joints.
struct JointReading {
  double stamp = 0;        // [s] run clock
  JointValues position{};  // [rad]
  JointValues rate{};      // [rad/s]
  bool operator==(const JointReading&) const = default;
};

/// Why real hardware holds its own wheels still, whatever the command. The port reports it after it
/// has acted. The health report names the device.
enum class Halt : std::uint8_t {
  None,
  Disarmed,      // nobody has enabled the motors
  BaseLost,      // the base is absent, or silent for too long
  ScannerLost,   // no whole scan for three of its periods
  BadLine,       // more damaged telegrams than whole ones
  ScannerFault,  // the scanner reports that its values are unreliable
  StopButton,    // pressed on the robot
  BaseFault,     // the motor controller reports a fault
  OverCurrent,   // a motor draws more than its limit
  BatteryLow,
  MotorsOff,   // armed, but the base has not switched its motors on
  LateTick,    // the control loop came too late for its own deadlines
  FloorLost,   // no reading of the sensors that look at the floor, for three of their periods
  FloorFault,  // their readings are not to be trusted
};

constexpr std::size_t kMostChannels = 256;

/// A further sensor's channel. The pipeline only passes its numbers on to the record, the page and
/// the export. A sensor that the pipeline acts on has its own field in Observation.
struct ChannelInfo {
  std::string name{};              // "air.temperature"
  std::string kind{};              // what the values are, for people and readers: "temperature"
  std::string unit{};              // of each value: "degC"
  std::uint32_t values = 1;        // per reading
  std::optional<Pose2> mount_R{};  // if its place matters
  bool operator==(const ChannelInfo&) const = default;
};

/// One reading of a channel. Its values keep their buffer.
struct ChannelReading {
  std::uint8_t channel = 0;  // index into RobotSpec::channels
  double stamp = 0;          // [s] run clock
  std::vector<double> values{};
  bool operator==(const ChannelReading&) const = default;
};

struct Observation {
  double stamp = 0;  // [s] run clock, the only clock algo sees
  Halt halt = Halt::None;
  Odometry odometry{};
  Recycled<LaserScan> scans{};  // empty if no new scan came this tick
  Recycled<RangeReading> sonar{};
  Recycled<RangeReading> infrared{};
  Recycled<BumperReading> bumpers{};
  std::optional<YawGyro> gyro{};
  std::optional<Inclinometer> inclinometer{};
  std::optional<Encoders> encoders{};
  LineImage line{};
  std::optional<FloorRanges> floor{};   // only if new in this tick
  Recycled<ChannelReading> channels{};  // only those new in this tick
  std::optional<JointReading> joints{};
  std::optional<MapPose> map_pose{};  // of a robot that knows a map
  /// The robot's own map moved in this tick, and its pose with it. The record does not keep it.
  std::shared_ptr<const MapMove> map_move{};

  bool bumper_pressed() const {
    for (const BumperReading& bumper : bumpers) {
      if (bumper.pressed) return true;
    }
    return false;
  }
  void clear_sensors() {
    scans.clear();
    sonar.clear();
    infrared.clear();
    bumpers.clear();
    gyro.reset();
    inclinometer.reset();
    encoders.reset();
    line.fresh = false;
    line.pixels.clear();
    floor.reset();
    channels.clear();
    joints.reset();
    map_pose.reset();
    map_move.reset();
  }
};

}  // namespace algo
