// algo/mapping/scan_odometry.cpp: match, then enter.
#include "algo/mapping/scan_odometry.hpp"

#include <cmath>

namespace algo {
namespace {

constexpr double kThinned = 0.08;          // [m] between two points that are matched
constexpr std::size_t kUsualBeams = 1024;  // reserved from the start

}  // namespace

ScanOdometry::ScanOdometry(const MapperSettings& settings)
    : settings_(settings), map_(settings.cell) {
  thinned_R_.reserve(kUsualBeams);
}

void ScanOdometry::reset(const Pose2& start_W, const Pose2& odometry) {
  map_ = OccupancyMap(settings_.cell);
  pose_W_ = start_W;
  odometry_ = odometry;
  entered_W_.reset();
}

void ScanOdometry::take(std::span<const Vec2> points_R,
                        const Vec2& scanner_R,
                        const Pose2& odometry) {
  const Pose2 step = pose_step(odometry_, odometry);
  const double way = step.position().norm() + std::abs(step.heading);
  if (entered_W_ && way < kMatchEvery) return;
  pose_W_ = compose(pose_W_, step);
  odometry_ = odometry;
  if (entered_W_) {
    thin(points_R);
    matcher_.take(thinned_R_);
    const ScanMatch match = matcher_.match(map_, pose_W_, settings_.prior);
    // A scan that hardly meets the map shows new walls: there the wheels know better.
    if (match.share >= settings_.lost) pose_W_ = match.pose_W;
  }
  if (!entered_W_ || apart(*entered_W_, pose_W_, settings_)) enter(points_R, scanner_R);
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
  const Vec2 from_W = to_parent(pose_W_, scanner_R);
  for (const Vec2& p_R : points_R) {
    if (p_R.norm() <= settings_.reach) map_.insert(from_W, to_parent(pose_W_, p_R));
  }
  entered_W_ = pose_W_;
}

}  // namespace algo
