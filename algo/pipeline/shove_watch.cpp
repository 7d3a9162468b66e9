// algo/pipeline/shove_watch.cpp: the share of beams that end off the earlier scan's surfaces.
#include "algo/pipeline/shove_watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "algo/full_strip/scan_points.hpp"

namespace algo {
namespace {

// Both shares are measured with all beams: in simulated rooms with people around it, at most 0.46
// of them changed in kApart without a shove. Shoves by 30 degrees or more reached 0.6; one by 3
// degrees reached 0.36. In two raw logs of real robots the odometry and the scans disagree so much
// every fifty seconds.
constexpr double kBegins = 0.5;  // share of changed beams with which a shove begins,
constexpr double kGoesOn = 0.3;  // and with which it goes on
constexpr int kInARow = 2;       // comparisons, while the wheels turn
constexpr double kApart = 0.19;  // [s] between compared scans, at least
// What may lie between them while the wheels turn: from farther off another scene is in view.
constexpr double kSoon = 0.5;           // [s]
constexpr double kFar = 0.5;            // [m]
constexpr double kStands = 0.02;        // [m], [rad] less than this is no motion of the wheels
constexpr double kTurned = 0.6;         // [rad]
constexpr double kOff = 0.08;           // [m] a changed beam ends this far off, at least
constexpr int kNeighbours = 2;          // beams: the error of a surface's bearing
constexpr double kReach = 8.0;          // [m]
constexpr std::size_t kCompared = 120;  // beams are enough, evenly spaced;
constexpr int kFewest = 40;             // fewer tell nothing
constexpr std::size_t kMostBeams = 4096;

/// The beam of `scan` nearest to the point, seen from `sensor_W`; it may be outside the scan.
long nearest_beam(const Pose2& sensor_W, const Vec2& point_W, const LaserScan& scan) {
  return std::lround(beam_at(sensor_W, point_W, scan.angle_min, scan.angle_increment));
}

}  // namespace

ShoveWatch::ShoveWatch() {
  ranges_.reserve(kMostBeams);
}

void ShoveWatch::reset() {
  ranges_.clear();
  off_in_a_row_ = 0;
}

bool ShoveWatch::take(const LaserScan& scan,
                      const Pose2& sensor_W,
                      const std::vector<Vec2>& points_W) {
  if (!(scan.angle_increment > 0)) return false;  // the beams have no order
  const bool alike = ranges_.size() == scan.size();
  if (alike && scan.stamp - stamp_ < kApart) return false;
  const double way = (sensor_W.position() - sensor_W_.position()).norm();
  const double turn = std::abs(wrap_angle(sensor_W.heading - sensor_W_.heading));
  const bool stood = way < kStands && turn < kStands;
  const bool soon = scan.stamp - stamp_ < kSoon;
  const bool comparable = alike && (stood || (soon && way < kFar && turn < kTurned));
  const double share = comparable ? changed(scan, points_W) : 0;
  const double least = off_in_a_row_ > 0 ? kGoesOn : kBegins;
  off_in_a_row_ = share > least ? off_in_a_row_ + 1 : 0;
  remember(scan, sensor_W, points_W);
  return off_in_a_row_ >= (stood ? 1 : kInARow);
}

void ShoveWatch::remember(const LaserScan& scan,
                          const Pose2& sensor_W,
                          const std::vector<Vec2>& points_W) {
  stamp_ = scan.stamp;
  sensor_W_ = sensor_W;
  ranges_.assign(scan.size(), 0);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (scan.status[i] != Beam::Ok) continue;
    const long at = nearest_beam(sensor_W, points_W[i], scan);
    if (at < 0 || at >= static_cast<long>(scan.size())) continue;
    ranges_[static_cast<std::size_t>(at)] = (points_W[i] - sensor_W.position()).norm();
  }
}

/// The share of beams that end off the surfaces of the earlier scan; 0 if too few can be compared.
double ShoveWatch::changed(const LaserScan& scan, const std::vector<Vec2>& points_W) const {
  int compared = 0;
  int off = 0;
  const std::size_t apart = std::max<std::size_t>(1, scan.size() / kCompared);
  for (std::size_t i = 0; i < scan.size(); i += apart) {
    if (scan.status[i] != Beam::Ok) continue;
    const long at = nearest_beam(sensor_W_, points_W[i], scan);
    if (at < kNeighbours || at + kNeighbours >= static_cast<long>(ranges_.size())) continue;
    double nearest = std::numeric_limits<double>::infinity();
    double farthest = 0;
    for (long k = at - kNeighbours; k <= at + kNeighbours; ++k) {
      const double range = ranges_[static_cast<std::size_t>(k)];
      if (range <= 0) continue;
      nearest = std::min(nearest, range);
      farthest = std::max(farthest, range);
    }
    if (farthest <= 0 || farthest > kReach) continue;
    const double range = (points_W[i] - sensor_W_.position()).norm();
    ++compared;
    if (range < nearest - kOff || range > farthest + kOff) ++off;
  }
  return compared < kFewest ? 0 : static_cast<double>(off) / compared;
}

}  // namespace algo
