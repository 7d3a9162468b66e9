// algo/observation.hpp: everything a robot sensed by one instant. A sensor it lacks stays empty.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "algo/laser_scan.hpp"
#include "algo/recycled.hpp"
#include "algo/types.hpp"

namespace algo {

/// Pose integrated from the encoders, and the twist of the last period.
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

/// Raw counts since reset; a difference is taken modulo 2^32 as signed.
struct Encoders {
  double stamp = 0;
  std::uint32_t left = 0;
  std::uint32_t right = 0;
  bool operator==(const Encoders&) const = default;
};

/// Why real hardware holds its own wheels still, whatever it is told. The port has done so already
/// when it says so; the device concerned is named where people look for devices.
enum class Halt : std::uint8_t {
  None,
  Disarmed,      // nobody has enabled the motors
  BaseLost,      // the base is not there, or has been silent for too long
  ScannerLost,   // no whole scan for three of its periods
  BadLine,       // more telegrams damaged than whole
  ScannerFault,  // the scanner says that its values must not be relied on
  StopButton,    // pressed on the robot
  BaseFault,     // the motor controller reports a fault
  OverCurrent,   // a motor takes more than it may
  BatteryLow,
  MotorsOff,  // armed, but the base has not switched its motors on
  LateTick,   // the control loop came too late for its own deadlines
};

constexpr std::size_t kMostChannels = 256;

/// What a further sensor of the robot reports: numbers that the pipeline only passes on, to record,
/// page and export. What it acts on has a field of its own in Observation.
struct ChannelInfo {
  std::string name{};              // "air.temperature"
  std::string kind{};              // what the values are: "temperature"; for people and readers
  std::string unit{};              // of each value: "degC"
  std::uint32_t values = 1;        // in a reading
  std::optional<Pose2> mount_R{};  // where a place matters
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
  Recycled<LaserScan> scans{};  // empty when no new one came this tick
  Recycled<RangeReading> sonar{};
  Recycled<RangeReading> infrared{};
  Recycled<BumperReading> bumpers{};
  std::optional<YawGyro> gyro{};
  std::optional<Inclinometer> inclinometer{};
  std::optional<Encoders> encoders{};
  Recycled<ChannelReading> channels{};  // only those new in this tick

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
    channels.clear();
  }
};

}  // namespace algo
