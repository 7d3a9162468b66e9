// sim/carmen_log.cpp: fields of a line, units, device codes.
#include "sim/carmen_log.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>

namespace sim {
namespace {

using std::numbers::pi;

constexpr std::size_t kMostReadings = 4096;  // far above any scanner in these logs
constexpr double kLargestReading = 1000;     // [m]

/// Takes fields from the front of a line.
class Fields {
 public:
  explicit Fields(std::string_view line) : rest_(line) {}

  /// Empty at the end of the line.
  std::string_view word() {
    constexpr std::string_view kBlank = " \t\r";
    const std::size_t begin = rest_.find_first_not_of(kBlank);
    if (begin == std::string_view::npos) {
      rest_ = {};
      return {};
    }
    rest_.remove_prefix(begin);
    const std::size_t end = std::min(rest_.find_first_of(kBlank), rest_.size());
    const std::string_view result = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return result;
  }
  /// A finite number, or nothing.
  std::optional<double> number() {
    const std::string_view text = word();
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    if (text.empty() || !std::isfinite(value)) return std::nullopt;
    return value;
  }
  std::optional<std::size_t> count(std::size_t most) {
    const auto value = number();
    if (!value || *value < 0 || *value > static_cast<double>(most)) return std::nullopt;
    if (*value != std::floor(*value)) return std::nullopt;
    return static_cast<std::size_t>(*value);
  }
  template <std::size_t N>
  bool numbers(std::array<double, N>& values) {
    for (double& value : values) {
      const auto next = number();
      if (!next) return false;
      value = *next;
    }
    return true;
  }

 private:
  std::string_view rest_{};
};

CarmenError error(std::string reason) {
  return CarmenError{std::move(reason)};
}

constexpr const char* kBadTrailer =
    "the time stamps at the end of the line are incomplete or followed by more";

/// `timestamp host logger_timestamp` and nothing after; the first is the sensor's.
std::optional<double> trailer(Fields& fields) {
  const auto stamp = fields.number();
  const std::string_view host = fields.word();
  const auto logger_stamp = fields.number();
  if (!stamp || host.empty() || !logger_stamp || !fields.word().empty()) return std::nullopt;
  return stamp;
}

std::optional<CarmenError> read_readings(Fields& fields, std::size_t n, CarmenScan& scan) {
  scan.readings.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto reading = fields.number();
    if (!reading || *reading < 0 || *reading > kLargestReading) {
      return error("reading " + std::to_string(i + 1) + " of " + std::to_string(n) +
                   " is missing or not a distance");
    }
    scan.readings.push_back(*reading);
  }
  return std::nullopt;
}

/// The end of a scan's line: `N` numbers, which begin with both poses, and the trailer.
template <std::size_t N>
CarmenLine finish_scan(Fields& fields, CarmenScan& scan) {
  std::array<double, N> poses{};
  if (!fields.numbers(poses)) return error("the poses after the readings are incomplete");
  scan.laser_W = {poses[0], poses[1], algo::wrap_angle(poses[2])};
  scan.robot_W = {poses[3], poses[4], algo::wrap_angle(poses[5])};
  const auto stamp = trailer(fields);
  if (!stamp) return error(kBadTrailer);
  scan.stamp = *stamp;
  return std::move(scan);
}

/// Scans with an even number of readings end one step before +90 degrees, others exactly there.
void spread_over_half_turn(CarmenScan& scan) {
  const std::size_t n = scan.readings.size();
  scan.angle_min = -pi / 2;
  scan.angle_increment = pi / static_cast<double>(n % 2 == 0 ? n : n - 1);
}

/// `n r1..rn x y theta odom_x odom_y odom_theta timestamp host logger_timestamp`
CarmenLine parse_flaser(Fields& fields, CarmenLaser laser) {
  CarmenScan scan;
  scan.laser = laser;
  const auto n = fields.count(kMostReadings);
  if (!n || *n < 2) return error("the number of readings is missing or out of bounds");
  if (auto problem = read_readings(fields, *n, scan)) return *problem;
  spread_over_half_turn(scan);
  return finish_scan<6>(fields, scan);
}

/// `type start_angle fov step max accuracy remission_mode n r1..rn nrem [rem] laser_x laser_y
/// laser_theta robot_x robot_y robot_theta laser_tv laser_rv forward_safety side_safety turn_axis
/// timestamp host logger_timestamp`, angles in radians.
CarmenLine parse_robotlaser(Fields& fields, CarmenLaser laser) {
  CarmenScan scan;
  scan.laser = laser;
  std::array<double, 7> head{};  // type, start angle, field of view, step, max, accuracy, remission
  if (!fields.numbers(head)) return error("the head of the scan is incomplete");
  scan.angle_min = head[1];
  scan.angle_increment = head[3];
  const auto n = fields.count(kMostReadings);
  if (!n || *n < 2) return error("the number of readings is missing or out of bounds");
  if (!(scan.angle_increment > 0) ||
      scan.angle_increment * static_cast<double>(*n - 1) > 2 * pi + 1e-3) {
    return error("the angular step is not above 0 or leads past a full turn");
  }
  if (std::abs(scan.angle_min) > 2 * pi) return error("the start angle is out of bounds");
  if (auto problem = read_readings(fields, *n, scan)) return *problem;
  const auto remissions = fields.count(kMostReadings);
  if (!remissions) return error("the number of remissions is missing or out of bounds");
  for (std::size_t i = 0; i < *remissions; ++i) {
    if (!fields.number()) return error("the remissions are incomplete");
  }
  return finish_scan<11>(fields, scan);
}

/// `x y theta tv rv accel timestamp host logger_timestamp`
CarmenLine parse_odom(Fields& fields) {
  std::array<double, 6> values{};
  if (!fields.numbers(values)) return error("a number of the odometry is missing or not finite");
  if (!trailer(fields)) return error(kBadTrailer);
  return CarmenOdometry{};
}

struct UnitRow {
  CarmenUnit unit{};
  std::uint32_t step_mm = 0;
  std::uint32_t top = 0;         // largest raw value: no echo
  std::uint32_t first_code = 0;  // raw values from here on are not distances
};
// From the first code of the device reference (top - 8); for the two units in known logs, from the
// value where their readings become meaningless.
constexpr std::array<UnitRow, 4> kUnits{{{CarmenUnit::Centimetre, 10, 8191, 8180},
                                         {CarmenUnit::Millimetre8m, 1, 8191, 8183},
                                         {CarmenUnit::Millimetre16m, 1, 16383, 16375},
                                         {CarmenUnit::Millimetre32m, 1, 32767, 32755}}};

const UnitRow& row_of(CarmenUnit unit) {
  return kUnits[static_cast<std::size_t>(unit)];
}

}  // namespace

CarmenLine parse_carmen_line(std::string_view line) {
  Fields fields(line);
  const std::string_view name = fields.word();
  if (name == "FLASER") return parse_flaser(fields, CarmenLaser::Front);
  if (name == "RLASER") return parse_flaser(fields, CarmenLaser::Rear);
  if (name == "ROBOTLASER1") return parse_robotlaser(fields, CarmenLaser::Front);
  if (name == "ROBOTLASER2") return parse_robotlaser(fields, CarmenLaser::Rear);
  if (name == "ODOM") return parse_odom(fields);
  return CarmenOther{};
}

void CarmenUnitGuess::see(std::uint32_t reading_mm) {
  finer_than_centimetres_ = finer_than_centimetres_ || reading_mm % 10 != 0;
  largest_mm_ = std::max(largest_mm_, reading_mm);
}

CarmenUnit CarmenUnitGuess::unit() const {
  if (!finer_than_centimetres_) return CarmenUnit::Centimetre;
  for (const UnitRow& row : kUnits) {
    if (row.step_mm == 1 && largest_mm_ <= row.top) return row.unit;
  }
  return CarmenUnit::Centimetre;  // averaged or converted: only its codes are certain
}

double carmen_range_max(CarmenUnit unit) {
  const UnitRow& row = row_of(unit);
  return row.top * row.step_mm / 1000.0;
}

std::uint16_t pack_carmen(std::uint32_t reading_mm, CarmenUnit unit) {
  const UnitRow& row = row_of(unit);
  const std::uint32_t raw = (reading_mm + row.step_mm / 2) / row.step_mm;
  if (raw < row.first_code) {
    return static_cast<std::uint16_t>(std::min<std::uint32_t>(reading_mm, algo::kPackedMaxRange));
  }
  // Codes end in 7, A, B, D, E or F; other values have no known code.
  const std::uint32_t digit = raw <= row.top && raw + 8 >= row.top ? raw & 0xFU : 0;
  switch (static_cast<algo::BeamCode>(digit)) {
    case algo::BeamCode::BeyondRange:
      return algo::kPackedFree;
    case algo::BeamCode::ReadError:
    case algo::BeamCode::WeakSignal:
    case algo::BeamCode::Overflow:
    case algo::BeamCode::Dazzled:
    case algo::BeamCode::NoEcho:
      return static_cast<std::uint16_t>(algo::kPackedCodeBase + digit);
    default:
      return static_cast<std::uint16_t>(algo::kPackedCodeBase +
                                        static_cast<std::uint16_t>(algo::BeamCode::Unknown));
  }
}

}  // namespace sim
