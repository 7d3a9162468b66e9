// sim/carmen_log.hpp: parses lines of CARMEN logs, without any I/O.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "algo/laser_scan.hpp"
#include "algo/types.hpp"

namespace sim {

/// The scanner of a line.
enum class CarmenLaser : std::uint8_t { Front, Rear };

/// FLASER, RLASER, ROBOTLASER1 or ROBOTLASER2.
struct CarmenScan {
  CarmenLaser laser = CarmenLaser::Front;
  double angle_min = 0;            // [rad] of the first reading, the right-most
  double angle_increment = 0;      // [rad]
  std::vector<double> readings{};  // [m] as written, including device codes
  algo::Pose2 laser_W{};
  algo::Pose2 robot_W{};
  double stamp = 0;  // [s] on the recording's clock; 0 if the log has none
};

/// ODOM: pose and speeds from the wheels; a scan contains them too.
struct CarmenOdometry {};

/// A comment, an empty line, or an unused message.
struct CarmenOther {};

/// A malformed scan or odometry line.
struct CarmenError {
  std::string reason{};  // "the line ends after 12 of 360 readings"
};

using CarmenLine = std::variant<CarmenOther, CarmenScan, CarmenOdometry, CarmenError>;

/// Parses one line without its line end. Never throws on any content.
CarmenLine parse_carmen_line(std::string_view line);

/// The unit of a file's readings: the device's resolution and measuring range. It is inferred from
/// the readings, since no log states it.
enum class CarmenUnit : std::uint8_t {
  Centimetre,     // 80 m in cm steps, codes from 81.80
  Millimetre8m,   // codes from 8.183
  Millimetre16m,  // codes from 16.375
  Millimetre32m,  // codes from 32.755
};

/// Collects readings until the unit is certain.
class CarmenUnitGuess {
 public:
  /// `reading_mm` [mm], rounded.
  void see(std::uint32_t reading_mm);
  CarmenUnit unit() const;

 private:
  bool finer_than_centimetres_ = false;
  std::uint32_t largest_mm_ = 0;
};

/// [m] Largest value that the device can write in this unit: its no-echo code.
double carmen_range_max(CarmenUnit unit);

/// A reading [mm] as a packed beam (algo/laser_scan.hpp): a distance, free, or a code. The log's
/// writer scaled the device's codes like distances; the last hexadecimal digit of the raw value
/// identifies them.
std::uint16_t pack_carmen(std::uint32_t reading_mm, CarmenUnit unit);

}  // namespace sim
