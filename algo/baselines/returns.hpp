// algo/baselines/returns.hpp: the returns that a baseline controller reads, once each: from the
// filtered front scan or, on a robot without a scanner, from the sonar ring.
#pragma once

#include <cmath>

#include "algo/controller.hpp"
#include "algo/geometry.hpp"

namespace algo {

/// True for a robot without a scanner: no front scan has ever come.
inline bool lacks_laser(const Scene& scene) {
  return scene.scan.size() == 0;
}

/// True if every number of the sonar ring is finite; checks ranges of Ok readings only.
inline bool finite_sonar(const Observation& observation) {
  for (const RangeReading& reading : observation.sonar) {
    const bool placed =
        finite(reading.mount_R) && std::isfinite(reading.stamp) && std::isfinite(reading.range_max);
    if (!placed || (reading.status == Beam::Ok && !std::isfinite(reading.range))) return false;
  }
  return true;
}

/// Calls visit(point_W) for every return that this tick reads; the newest scan may be older than
/// the tick.
template <typename Visit>
void for_each_return(const ControlInput& in, Visit&& visit) {
  const LaserScan& scan = in.scene->scan;
  const Pose2& pose = in.odometry.pose;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (scan.status[i] != Beam::Ok) continue;
    visit(beam_point_W(pose, scan.mount_R, scan.angle(i), scan.ranges[i]));
  }
  if (!lacks_laser(*in.scene)) return;
  for (const RangeReading& reading : in.observation->sonar) {
    if (reading.status != Beam::Ok) continue;
    visit(beam_point_W(pose, reading.mount_R, 0, reading.range));
  }
}

/// Tells whether a scan is new: a grid may count each reading only once. Sonar readings arrive in
/// the tick in which they were taken, so they are always new.
class NewPicture {
 public:
  void reset() { stamp_.reset(); }
  bool operator()(const Scene& scene) {
    if (lacks_laser(scene)) return true;
    const bool fresh = !stamp_ || *stamp_ != scene.scan.stamp;
    stamp_ = scene.scan.stamp;
    return fresh;
  }

 private:
  std::optional<double> stamp_{};  // [s] of the newest scan seen
};

}  // namespace algo
