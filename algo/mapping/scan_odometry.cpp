// algo/mapping/scan_odometry.cpp: match, then enter.
#include "algo/mapping/scan_odometry.hpp"

namespace algo {
namespace {

constexpr std::size_t kUsualBeams = 1024;  // reserved from the start
// What the map is off by near the robot: it was drawn by the same wheels not long ago.
constexpr double kOwnMapError = 0.03;       // [m]
constexpr double kOwnMapTurnError = 0.006;  // [rad]
constexpr double kAtStart = 0.01;           // [m] deviation of the place where the map begins
constexpr double kTurnAtStart = 0.01;       // [rad]

}  // namespace

ScanOdometry::ScanOdometry(const MapperSettings& settings)
    : settings_(settings), map_(settings.cell), place_({}, kAtStart, kTurnAtStart) {
  scan_R_.points.reserve(kUsualBeams);
  scan_R_.facings.reserve(kUsualBeams);
}

void ScanOdometry::reset(const Pose2& start_W, const Pose2& odometry) {
  map_ = OccupancyMap(settings_.cell);
  place_ = PlaceFilter(start_W, kAtStart, kTurnAtStart);
  odometry_ = odometry;
  entered_W_.reset();
}

void ScanOdometry::take(std::span<const Vec2> points_R,
                        const Vec2& scanner_R,
                        const Pose2& odometry) {
  place_.follow(pose_step(odometry_, odometry));
  odometry_ = odometry;
  if (entered_W_ && !place_.due()) return;
  keep_near(points_R);
  find_facings(scan_R_.points, scanner_R, scan_R_.facings);
  if (entered_W_) {
    matcher_.take(scan_R_);
    const ScanMatch match = matcher_.match(map_, place_.pose_M(), settings_.prior);
    place_.take(match, match.share, {kOwnMapError, kOwnMapError, kOwnMapTurnError});
  }
  if (!entered_W_ || apart(*entered_W_, place_.pose_M(), settings_)) enter(scanner_R);
}

void ScanOdometry::keep_near(std::span<const Vec2> points_R) {
  scan_R_.points.clear();
  for (const Vec2& p_R : points_R) {
    if (p_R.norm() <= settings_.reach) scan_R_.points.push_back(p_R);
  }
}

void ScanOdometry::enter(const Vec2& scanner_R) {
  const Pose2& pose_W = place_.pose_M();
  const Vec2 from_W = to_parent(pose_W, scanner_R);
  for (std::size_t i = 0; i < scan_R_.points.size(); ++i) {
    map_.insert(
        from_W, to_parent(pose_W, scan_R_.points[i]), scan_R_.facings[i].turned(pose_W.heading));
  }
  entered_W_ = pose_W;
}

}  // namespace algo
