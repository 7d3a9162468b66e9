// algo/pipeline/mover_watch.cpp: tracks, and the places that they have left.
#include "algo/pipeline/mover_watch.hpp"

namespace algo {
namespace {

constexpr double kAroundMover = 0.05;  // [m] around its circle, where its hits may lie

}  // namespace

void MoverWatch::reset() {
  tracker_.reset();
  stamp_ = -std::numeric_limits<double>::infinity();
}

void MoverWatch::take(const LaserScan& scan,
                      const Pose2& sensor_W,
                      const std::vector<Vec2>& points_W,
                      LocalMap& map) {
  if (!(scan.stamp > stamp_)) return;
  if (scan.stamp - stamp_ > kGap) tracker_.reset();
  tracker_.predict(stamp_);
  for (const Track& track : tracker_.moving()) {
    if (!track.moves || track.unseen > 0) continue;
    const double reach = track.radius + kAroundMover;
    map.erase_near(track.position_W, reach, [&](const Vec2& point_W) {
      return (point_W - track.position_W).squaredNorm() < reach * reach;
    });
  }
  tracker_.update(scan, sensor_W, points_W);
  stamp_ = scan.stamp;
}

}  // namespace algo
