// algo/full_strip/scan_points.hpp: the positions of a scan's returns, for a scanner that sweeps
// while the robot moves.
#pragma once

#include <vector>

#include "algo/laser_scan.hpp"
#include "algo/types.hpp"

namespace algo {

/// Remembers the robot's poses, and maps each beam of a scan from the pose at which it was fired.
class ScanPoints {
 public:
  ScanPoints();
  void reset() { trail_.clear(); }
  /// Adds the odometry pose `pose_W` at `stamp` [s]. Call once per tick, in order.
  void follow(const Pose2& pose_W, double stamp);
  /// Maps the valid beams of `scan` into points_W(). Returns the scanner's pose at the middle of
  /// its sweep. Call follow() first.
  Pose2 map(const LaserScan& scan);
  /// One point per beam; a beam without a distance keeps its old point.
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
