// algo/full_strip/scan_points.cpp: one frame per beam for a sweeping scanner, else one per scan.
#include "algo/full_strip/scan_points.hpp"

#include <algorithm>
#include <cstddef>

namespace algo {
namespace {

constexpr std::size_t kTrail = 64;  // poses remembered

/// A frame prepared to map many points.
struct Frame {
  Vec2 origin{0, 0};
  Vec2 ahead{1, 0};
  Vec2 left{0, 1};
};
/// The frame of a scanner at `mount_R` on a robot at `robot_W`. Most scanners look straight ahead,
/// so that both headings have the same sine.
Frame frame_of(const Pose2& robot_W, const Pose2& mount_R) {
  const Vec2 robot_ahead = direction(robot_W.heading);
  const Vec2 robot_left(-robot_ahead.y(), robot_ahead.x());
  const Vec2 origin = robot_W.position() + mount_R.x * robot_ahead + mount_R.y * robot_left;
  const double heading = wrap_angle(robot_W.heading + mount_R.heading);
  const Vec2 ahead = heading == robot_W.heading ? robot_ahead : direction(heading);
  return {origin, ahead, {-ahead.y(), ahead.x()}};
}

}  // namespace

ScanPoints::ScanPoints() {
  trail_.reserve(kTrail + 1);
}

void ScanPoints::follow(const Pose2& pose_W, double stamp) {
  trail_.push_back({stamp, pose_W});
  if (trail_.size() > kTrail) trail_.erase(trail_.begin());
}

/// The pose interpolated at `stamp`.
Pose2 ScanPoints::pose_at(double stamp) const {
  for (std::size_t i = trail_.size(); i-- > 1;) {
    const Place& a = trail_[i - 1];
    const Place& b = trail_[i];
    if (stamp < a.stamp && i > 1) continue;
    const double span = b.stamp - a.stamp;
    const double t = span > 0 ? std::clamp((stamp - a.stamp) / span, 0.0, 1.0) : 1;
    return interpolated(a.pose_W, b.pose_W, t);
  }
  return trail_.back().pose_W;
}

Pose2 ScanPoints::map(const LaserScan& scan) {
  points_W_.resize(scan.size());
  const std::vector<Vec2>& beams = beams_.of(scan);
  const bool rolling = scan.turn_period > 0;
  const Pose2 middle_W = pose_at(scan.stamp - scan.sweep_time() / 2);
  Frame at = frame_of(middle_W, scan.mount_R);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (scan.status[i] != Beam::Ok) continue;
    if (rolling) at = frame_of(pose_at(scan.beam_time(i)), scan.mount_R);
    points_W_[i] = at.origin + scan.ranges[i] * (at.ahead * beams[i].x() + at.left * beams[i].y());
  }
  return compose(middle_W, scan.mount_R);
}

}  // namespace algo
