// algo/sensor_merge.hpp: what the sonar ring and the infrared scanners returned, entered into the
// front scan where its scanner did not see it.
#pragma once

#include <cstddef>
#include <limits>

#include "algo/observation.hpp"
#include "algo/recycled.hpp"
#include "algo/types.hpp"

namespace algo {

/// What is low, high or transparent lies outside a laser's plane. Entered into the scan, the
/// returns of the other sensors are obstacles to all that look at the scan: the search for the
/// nearest point on either side, the forces, the side choice, maps and clearances.
///
/// A reading holds until its sensor's beam is read again, for kMemory at most, fixed to W. It is
/// explained, and left out, when the laser returns from as near within the sensor's beam: a sonar
/// does not know where in its cone the echo came from, so that its axis would be a guess. Otherwise
/// it stands in for the beams within kHalfBeam of its axis. Allocates only while sensors appear.
class SensorMerge {
 public:
  static constexpr double kMemory = 0.5;       // [s]
  static constexpr double kHalfBeam = 0.0175;  // [rad] 1 degree: infrared, and what is filled in
  static constexpr double kHalfCone = 0.2618;  // [rad] 15 degrees: sonar
  static constexpr double kAsNear = 0.15;      // [m] a laser return may be farther and explain it
  static constexpr std::size_t kArc = 5;       // points of an echo that is no beam's

  void reset() { kept_.clear(); }

  /// Takes this tick's readings, of a robot at `observation.odometry`.
  void take(const Observation& observation);

  /// Enters into `scan`, of a robot at `pose_W` at `now` [s, run clock], what is not explained.
  void enter(const Pose2& pose_W, double now, LaserScan& scan);

  /// Calls `see(point_W)` for what was returned from where `scan` has no beams: behind a robot
  /// whose scanner looks ahead. A sonar's echo may have come from anywhere over its cone, so that
  /// it makes kArc points.
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
    Vec2 from_W{0, 0};  // where the sensor was
    Vec2 point_W{0, 0};
    double range = 0, bearing = 0;  // [m], [rad] from the scanner that it is entered for,
    bool missed = false;            // which did not see it
  };
  static bool holds(const Kept& kept, double now);
  static bool within(const Kept& kept, const Pose2& pose_W, const LaserScan& scan);
  static Vec2 arc_point(const Kept& kept, std::size_t k, std::size_t points);
  static bool explained(const Kept& kept, const LaserScan& scan);
  Kept& place_of(const Pose2& mount_R, double half_width);
  void take(const Recycled<RangeReading>& readings, const Pose2& pose_W, double half_width);

  Recycled<Kept> kept_{};   // one a sensor's beam
  std::size_t cursor_ = 0;  // where the next reading is looked for first: they come in one order
};

}  // namespace algo
