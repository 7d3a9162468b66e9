// algo/full_strip/scan_points.hpp: where the returns of a scan lie, of a scanner that turns while
// the robot moves.
#pragma once

#include <vector>

#include "algo/laser_scan.hpp"
#include "algo/types.hpp"

namespace algo {

/// Remembers where the robot was, and maps each beam of a scan from where it was fired.
class ScanPoints {
 public:
  ScanPoints();
  void reset() { trail_.clear(); }
  /// The robot is at `pose_W` at `stamp` [s], by its odometry; once a tick, in order.
  void follow(const Pose2& pose_W, double stamp);
  /// Maps the believed beams of `scan` into points_W(). The scanner's pose at the middle of its
  /// sweep. follow() must have been called.
  Pose2 map(const LaserScan& scan);
  /// One a beam; where no distance was measured, what was there before.
  const std::vector<Vec2>& points_W() const { return points_W_; }

 private:
  struct Place {
    double stamp = 0;  // [s]
    Pose2 pose_W{};
  };
  Pose2 pose_at(double stamp) const;

  std::vector<Place> trail_{};  // newest last
  BeamDirections beams_{};      // in the scanner's frame
  std::vector<Vec2> points_W_{};
};

}  // namespace algo
