// algo/pipeline/shove_watch.hpp: notices that somebody moved the robot without its wheels.
#pragma once

#include <vector>

#include "algo/laser_scan.hpp"
#include "algo/types.hpp"

namespace algo {

/// Compares each scan with one taken a little earlier. Where the odometry holds, most beams end on
/// the surfaces that the earlier scan shows; people in view change some. In a shove, or while the
/// robot is carried, most beams end elsewhere. One such comparison is a shove if the wheels stand,
/// two in a row if they turn, since turning wheels make the odometry less exact.
class ShoveWatch {
 public:
  ShoveWatch();
  void reset();
  /// Takes a scan: `sensor_W` is the scanner's pose in the odometry frame at the middle of its
  /// sweep, `points_W` B points (only those of Ok beams count). True while the scans do not fit the
  /// odometry: what the robot knew about its surroundings lies elsewhere now.
  bool take(const LaserScan& scan, const Pose2& sensor_W, const std::vector<Vec2>& points_W);

 private:
  void remember(const LaserScan& scan, const Pose2& sensor_W, const std::vector<Vec2>& points_W);
  double changed(const LaserScan& scan, const std::vector<Vec2>& points_W) const;

  // The earlier scan, as if all its beams had been fired from one place.
  double stamp_ = 0;  // [s]
  Pose2 sensor_W_{};
  std::vector<double> ranges_{};  // [m] by bearing; 0: none. Empty before the first scan.
  int off_in_a_row_ = 0;          // comparisons
};

}  // namespace algo
