// algo/sensor_merge.hpp: enters the returns of the sonar ring and the infrared scanners into the
// front scan where its scanner missed them.
#pragma once

#include <cstddef>
#include <limits>

#include "algo/observation.hpp"
#include "algo/recycled.hpp"
#include "algo/types.hpp"

namespace algo {

/// Obstacles that are low, high or transparent lie outside the laser's plane. Once entered, the
/// returns of the other sensors are obstacles to every reader of the scan: the nearest points on
/// either side, the forces, the side choice, maps and clearances.
///
/// A reading, fixed to W, holds until its sensor's beam is read again, for kMemory at most. It
/// counts as explained, and is left out, if the laser returns from as near within the sensor's
/// beam: the origin of a sonar's echo within its cone is unknown, so its axis would be a guess.
/// Otherwise the reading replaces the beams within kHalfBeam of its axis. Allocates only while new
/// sensors appear.
class SensorMerge {
 public:
  static constexpr double kMemory = 0.5;       // [s]
  static constexpr double kHalfBeam = 0.0175;  // [rad] 1 degree: infrared, and the beams replaced
  static constexpr double kHalfCone = 0.2618;  // [rad] 15 degrees: sonar
  static constexpr double kAsNear = 0.15;  // [m] a laser return up to this much farther explains it
  static constexpr std::size_t kArc = 5;   // points of an echo outside the beams

  void reset() { kept_.clear(); }

  /// Takes this tick's readings. The robot is at `observation.odometry`.
  void take(const Observation& observation);

  /// Enters the unexplained readings into `scan`. The robot is at `pose_W` at `now` [s, run clock].
  void enter(const Pose2& pose_W, double now, LaserScan& scan);

  /// Calls `see(point_W)` for returns from directions where `scan` has no beams: behind a robot
  /// whose scanner looks ahead. A sonar's echo may come from anywhere in its cone, so it gives kArc
  /// points.
  template <typename See>
  void each_beside(const Pose2& pose_W, double now, const LaserScan& scan, See&& see) const {
    for (const Kept& kept : kept_) {
      if (!holds(kept, now) || within(kept, pose_W, scan)) continue;
      const std::size_t points = kept.half_width > kHalfBeam ? kArc : 1;
      for (std::size_t k = 0; k < points; ++k) see(arc_point(kept, k, points));
    }
  }

 private:
  struct Kept {
    Pose2 mount_R{};
    double half_width = 0;                                    // [rad]
    double stamp = -std::numeric_limits<double>::infinity();  // [s] run clock
    bool hit = false;
    Vec2 from_W{0, 0};  // position of the sensor
    Vec2 point_W{0, 0};
    double range = 0, bearing = 0;  // [m], [rad] from the scanner of the scan it enters
    bool missed = false;            // that scanner did not see it
  };
  static bool holds(const Kept& kept, double now);
  static bool within(const Kept& kept, const Pose2& pose_W, const LaserScan& scan);
  static Vec2 arc_point(const Kept& kept, std::size_t k, std::size_t points);
  static bool explained(const Kept& kept, const LaserScan& scan);
  Kept& place_of(const Pose2& mount_R, double half_width);
  void take(const Recycled<RangeReading>& readings, const Pose2& pose_W, double half_width);

  Recycled<Kept> kept_{};   // one per sensor beam
  std::size_t cursor_ = 0;  // where to look for the next reading first: their order repeats
};

}  // namespace algo
