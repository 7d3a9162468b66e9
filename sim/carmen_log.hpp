// sim/carmen_log.hpp: lines of CARMEN logs to values, without any I/O.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "algo/laser_scan.hpp"
#include "algo/types.hpp"

namespace sim {

/// Which scanner a line belongs to.
enum class CarmenLaser : std::uint8_t { Front, Rear };

/// FLASER, RLASER, ROBOTLASER1 or ROBOTLASER2.
struct CarmenScan {
  CarmenLaser laser = CarmenLaser::Front;
  double angle_min = 0;            // [rad] of the first reading, the right-most
  double angle_increment = 0;      // [rad]
  std::vector<double> readings{};  // [m] as written, device codes and all
  algo::Pose2 laser_W{};
  algo::Pose2 robot_W{};
  double stamp = 0;  // [s] of the recording's clock; 0 when the log has none
};

/// ODOM: pose and speeds from the wheels, which a scan brings too.
struct CarmenOdometry {};

/// A comment, an empty line, or a message of no interest here.
struct CarmenOther {};

/// A line that should have been a scan or an odometry and is not.
struct CarmenError {
  std::string reason{};  // "the line ends after 12 of 360 readings"
};

using CarmenLine = std::variant<CarmenOther, CarmenScan, CarmenOdometry, CarmenError>;

/// One line without its line end. Never throws on what the line holds.
CarmenLine parse_carmen_line(std::string_view line);

/// What the readings of a file are steps of: the device's unit and measuring range, told from the
/// readings themselves, since no log says so.
enum class CarmenUnit : std::uint8_t {
  Centimetre,     // 80 m in cm steps, codes from 81.80
  Millimetre8m,   // codes from 8.183
  Millimetre16m,  // codes from 16.375
  Millimetre32m,  // codes from 32.755
};

/// Gathers readings until the unit can be told.
class CarmenUnitGuess {
 public:
  /// `reading_mm` [mm] rounded.
  void see(std::uint32_t reading_mm);
  CarmenUnit unit() const;

 private:
  bool finer_than_centimetres_ = false;
  std::uint32_t largest_mm_ = 0;
};

/// [m] Largest value the device can write in this unit, its no-echo code.
double carmen_range_max(CarmenUnit unit);

/// A reading [mm] as a packed beam (algo/laser_scan.hpp): a distance, free, or a code.
/// The device's codes were scaled like distances when the log was written; the last hexadecimal
/// digit of the raw value tells them apart.
std::uint16_t pack_carmen(std::uint32_t reading_mm, CarmenUnit unit);

}  // namespace sim
