// algo/sensor_merge.cpp: keeps readings and enters them in place of beams.
#include "algo/sensor_merge.hpp"

#include <cmath>

#include "algo/geometry.hpp"

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
    // A base reports all of its sonars each time: one without a new reading stays where it was.
    if (kept.stamp == reading.stamp) continue;
    kept.stamp = reading.stamp;
    kept.hit = reading.status == Beam::Ok && std::isfinite(reading.range);
    if (!kept.hit) continue;
    kept.from_W = to_parent(pose_W, reading.mount_R.position());
    kept.point_W = beam_point_W(pose_W, reading.mount_R, 0, reading.range);
  }
}

void SensorMerge::take(const Observation& observation) {
  take(observation.sonar, observation.odometry.pose, kHalfCone);
  take(observation.infrared, observation.odometry.pose, kHalfBeam);
}

bool SensorMerge::holds(const Kept& kept, double now) {
  // Written so that NaN gives false.
  return kept.hit && now - kept.stamp <= kMemory;
}

/// True if `scan` has a beam in the direction of `kept`'s return.
bool SensorMerge::within(const Kept& kept, const Pose2& pose_W, const LaserScan& scan) {
  const Pose2 sensor_W = compose(pose_W, scan.mount_R);
  const Vec2 p = to_child(sensor_W, kept.point_W);
  const double bearing = std::atan2(p.y(), p.x());
  const BeamSpan beams = beams_between(scan, bearing - kHalfBeam, bearing + kHalfBeam);
  return beams.begin < beams.end;
}

/// The `k`th of `points`, spread evenly over the cone at the distance of the echo.
Vec2 SensorMerge::arc_point(const Kept& kept, std::size_t k, std::size_t points) {
  if (points < 2) return kept.point_W;
  const double share = static_cast<double>(k) / static_cast<double>(points - 1);
  const Vec2 turn = direction((2 * share - 1) * kept.half_width);
  const Vec2 way = kept.point_W - kept.from_W;
  return kept.from_W +
         Vec2(turn.x() * way.x() - turn.y() * way.y(), turn.y() * way.x() + turn.x() * way.y());
}

void SensorMerge::enter(const Pose2& pose_W, double now, LaserScan& scan) {
  const Pose2 sensor_W = compose(pose_W, scan.mount_R);
  // First compare all readings with the laser alone, then enter them, so that none explains
  // another.
  for (Kept& kept : kept_) {
    kept.missed = false;
    if (!holds(kept, now)) continue;
    const Vec2 p = to_child(sensor_W, kept.point_W);
    kept.range = p.norm();
    kept.bearing = std::atan2(p.y(), p.x());
    kept.missed = kept.range < scan.range_max && !explained(kept, scan);
  }
  for (const Kept& kept : kept_) {
    if (!kept.missed) continue;
    const BeamSpan filled = beams_between(scan, kept.bearing - kHalfBeam, kept.bearing + kHalfBeam);
    for (std::size_t i = filled.begin; i < filled.end; ++i) {
      const bool nearer = scan.status[i] == Beam::Ok && scan.ranges[i] <= kept.range;
      if (!nearer) scan.set_from_other_sensor(i, kept.range);
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
