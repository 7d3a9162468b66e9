// algo/full_strip/scan_points.hpp: the positions of a scan's returns, for a scanner that sweeps
// while the robot moves.
#pragma once

#include <cmath>
#include <vector>

#include "algo/laser_scan.hpp"
#include "algo/types.hpp"

namespace algo {

/// The index of the beam that looks at the point, for a scanner at `sensor_W`; it may lie between
/// two beams or outside the scan. `angle_min` and `increment` are the scan's [rad].
inline double beam_at(const Pose2& sensor_W,
                      const Vec2& point_W,
                      double angle_min,
                      double increment) {
  const Vec2 p = to_child(sensor_W, point_W);
  return (std::atan2(p.y(), p.x()) - angle_min) / increment;
}

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
