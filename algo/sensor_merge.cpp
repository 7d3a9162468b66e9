// algo/sensor_merge.cpp: kept readings and the beams they stand in for.
#include "algo/sensor_merge.hpp"

#include <algorithm>
#include <cmath>

#include "algo/geometry.hpp"
#include "algo/mapping/pose_step.hpp"

namespace algo {

SensorMerge::Kept& SensorMerge::place_of(const Pose2& mount_R, double half_width) {
  for (std::size_t k = 0; k < kept_.size(); ++k) {
    const std::size_t at = (cursor_ + k) % kept_.size();
    Kept& kept = kept_[at];
    if (kept.mount_R != mount_R || kept.half_width != half_width) continue;
    cursor_ = at + 1;
    return kept;
  }
  Kept& fresh = kept_.append();
  fresh = {};
  fresh.mount_R = mount_R;
  fresh.half_width = half_width;
  return fresh;
}

void SensorMerge::take(const Recycled<RangeReading>& readings,
                       const Pose2& pose_W,
                       double half_width) {
  for (const RangeReading& reading : readings) {
    if (reading.status == Beam::Invalid) continue;
    Kept& kept = place_of(reading.mount_R, half_width);
    kept.stamp = reading.stamp;
    kept.hit = reading.status == Beam::Ok && std::isfinite(reading.range);
    if (kept.hit) kept.point_W = beam_point_W(pose_W, reading.mount_R, 0, reading.range);
  }
}

void SensorMerge::take(const Observation& observation) {
  take(observation.sonar, observation.odometry.pose, kHalfCone);
  take(observation.infrared, observation.odometry.pose, kHalfBeam);
}

void SensorMerge::enter(const Pose2& pose_W, double now, LaserScan& scan) {
  const Pose2 sensor_W = compose(pose_W, scan.mount_R);
  // First all questions to the laser alone, then all answers: none explains another.
  for (Kept& kept : kept_) {
    kept.missed = false;
    // Written so that what is not a number is not entered.
    if (!kept.hit || !(now - kept.stamp <= kMemory)) continue;
    const Vec2 p = pose_step(sensor_W, {kept.point_W.x(), kept.point_W.y(), 0}).position();
    kept.range = p.norm();
    kept.bearing = std::atan2(p.y(), p.x());
    kept.missed = kept.range < scan.range_max && !explained(kept, scan);
  }
  for (const Kept& kept : kept_) {
    if (!kept.missed) continue;
    const BeamSpan filled = beams_between(scan, kept.bearing - kHalfBeam, kept.bearing + kHalfBeam);
    for (std::size_t i = filled.begin; i < filled.end; ++i) {
      const bool nearer = scan.status[i] == Beam::Ok && scan.ranges[i] <= kept.range;
      if (!nearer) scan.set_ok(i, kept.range);
    }
  }
}

bool SensorMerge::explained(const Kept& kept, const LaserScan& scan) {
  const BeamSpan looked =
      beams_between(scan, kept.bearing - kept.half_width, kept.bearing + kept.half_width);
  for (std::size_t i = looked.begin; i < looked.end; ++i) {
    if (scan.status[i] == Beam::Ok && scan.ranges[i] <= kept.range + kAsNear) return true;
  }
  return false;
}

}  // namespace algo
