// algo/pipeline/mover_watch.cpp: tracks in the scans of one scanner.
#include "algo/pipeline/mover_watch.hpp"

namespace algo {

void MoverWatch::reset() {
  tracker_.reset();
  stamp_ = -std::numeric_limits<double>::infinity();
}

void MoverWatch::take(const LaserScan& scan,
                      const Pose2& sensor_W,
                      const std::vector<Vec2>& points_W) {
  if (!(scan.stamp > stamp_)) return;
  if (scan.stamp - stamp_ > kGap) tracker_.reset();
  tracker_.update(scan, sensor_W, points_W);
  stamp_ = scan.stamp;
}

}  // namespace algo
