// algo/mapping/scan_odometry.cpp: match, then enter.
#include "algo/mapping/scan_odometry.hpp"

#include <utility>

namespace algo {
namespace {

constexpr double kThinned = 0.08;          // [m] between two points that are matched
constexpr std::size_t kUsualBeams = 1024;  // reserved from the start
// What the map is off by near the robot: it was drawn by the same wheels not long ago.
constexpr double kOwnMapError = 0.03;       // [m]
constexpr double kOwnMapTurnError = 0.006;  // [rad]
constexpr double kAtStart = 0.01;           // [m] deviation of the place where the map begins
constexpr double kTurnAtStart = 0.01;       // [rad]

/// The faces of a map's walls that can be seen from `from_W`.
struct FacesSeen {
  const OccupancyMap& map;
  Vec2 from_W;
  template <typename See>
  void each_near(const Vec2& p_W, double reach, See&& see) const {
    map.each_facing(p_W, {from_W - p_W, false}, reach, std::forward<See>(see));
  }
};

}  // namespace

ScanOdometry::ScanOdometry(const MapperSettings& settings)
    : settings_(settings), map_(settings.cell), place_({}, kAtStart, kTurnAtStart) {
  thinned_R_.reserve(kUsualBeams);
  facings_R_.reserve(kUsualBeams);
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
  if (entered_W_) {
    thin(points_R);
    matcher_.take(thinned_R_);
    const ScanMatch match = matcher_.match(
        FacesSeen{map_, to_parent(place_.pose_M(), scanner_R)}, place_.pose_M(), settings_.prior);
    place_.take(match, match.share, {kOwnMapError, kOwnMapError, kOwnMapTurnError});
  }
  if (!entered_W_ || apart(*entered_W_, place_.pose_M(), settings_)) enter(points_R, scanner_R);
}

/// Keeps points a little apart, so that near walls do not outweigh far ones.
void ScanOdometry::thin(std::span<const Vec2> points_R) {
  thinned_R_.clear();
  for (const Vec2& p_R : points_R) {
    if (p_R.norm() > settings_.reach) continue;
    if (!thinned_R_.empty() && (p_R - thinned_R_.back()).norm() < kThinned) continue;
    thinned_R_.push_back(p_R);
  }
}

void ScanOdometry::enter(std::span<const Vec2> points_R, const Vec2& scanner_R) {
  const Pose2& pose_W = place_.pose_M();
  const Vec2 from_W = to_parent(pose_W, scanner_R);
  find_facings(points_R, scanner_R, facings_R_);
  for (std::size_t i = 0; i < points_R.size(); ++i) {
    if (points_R[i].norm() > settings_.reach) continue;
    map_.insert(from_W, to_parent(pose_W, points_R[i]), facings_R_[i].turned(pose_W.heading));
  }
  entered_W_ = pose_W;
}

}  // namespace algo
