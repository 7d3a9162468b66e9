// algo/pipeline/rear_watch.cpp: sorts beams and cones into the sectors behind the robot.
#include "algo/pipeline/rear_watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "algo/sensor_merge.hpp"

namespace algo {
namespace {

constexpr double kHalfField = std::numbers::pi / 4;  // [rad] either side of straight back
constexpr double kNever = -std::numeric_limits<double>::infinity();

/// [rad] Angle from straight back to `bearing_R`.
double from_back(double bearing_R) {
  return wrap_angle(bearing_R - std::numbers::pi);
}

/// True if a beam of `scan` may look back: saves checking each beam of scanners that look ahead.
bool reaches_back(const LaserScan& scan) {
  const double half = scan.angle_increment * static_cast<double>(scan.size()) / 2;
  const double middle = scan.mount_R.heading + scan.angle_min + half;
  return std::abs(from_back(middle)) < half + kHalfField;
}

}  // namespace

void RearWatch::reset() {
  looked_at_.fill(kNever);
}

/// Marks the sectors whose middle lies between `from` and `to` [rad from straight back], and a
/// sector that contains both.
void RearWatch::look(double from, double to, double stamp) {
  constexpr double kWidth = 2 * kHalfField / static_cast<double>(kSectors);
  for (std::size_t k = 0; k < kSectors; ++k) {
    const double low = -kHalfField + kWidth * static_cast<double>(k);
    const double middle = low + kWidth / 2;
    const bool covered = from <= middle && middle <= to;
    const bool beam_inside = from >= low && to <= low + kWidth;
    if (covered || beam_inside) looked_at_[k] = std::max(looked_at_[k], stamp);
  }
}

void RearWatch::take(const Observation& observation) {
  for (const LaserScan& scan : observation.scans) {
    if (!reaches_back(scan)) continue;
    for (std::size_t i = 0; i < scan.size(); ++i) {
      if (scan.status[i] == Beam::Invalid) continue;
      const double bearing = from_back(scan.mount_R.heading + scan.angle(i));
      if (std::abs(bearing) <= kHalfField) look(bearing, bearing, scan.stamp);
    }
  }
  const auto ring = [this](const Recycled<RangeReading>& readings, double half_width) {
    for (const RangeReading& reading : readings) {
      if (reading.status == Beam::Invalid) continue;
      const double bearing = from_back(reading.mount_R.heading);
      look(bearing - half_width, bearing + half_width, reading.stamp);
    }
  };
  ring(observation.sonar, SensorMerge::kHalfCone);
  ring(observation.infrared, 0);
}

bool RearWatch::looks(double now) const {
  return std::ranges::all_of(looked_at_, [now](double at) { return now - at <= kMemory; });
}

}  // namespace algo
