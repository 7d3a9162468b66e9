// algo/mapping/mapper.cpp: places, matches and enters scans.
#include "algo/mapping/mapper.hpp"

#include <cmath>

namespace algo {

Mapper::Mapper(const MapperSettings& settings, int side, const Vec2& centre_W)
    : settings_(settings), map_(settings.cell, side, centre_W) {}

Pose2 Mapper::add(const LaserScan& scan, const Pose2& odometry_W) {
  if (odometry_W_) {
    place(scan, compose(match_.pose_W, pose_step(*odometry_W_, odometry_W)));
  } else {
    match_ = {odometry_W, 1};
  }
  odometry_W_ = odometry_W;
  if (is_new()) {
    map_.insert(scan, compose(match_.pose_W, scan.mount_R), settings_.reach);
    entered_W_ = match_.pose_W;
  }
  return match_.pose_W;
}

void Mapper::place(const LaserScan& scan, const Pose2& guess_W) {
  match_ = {guess_W, 0};
  if (!settings_.match) return;
  matcher_.take(scan, settings_.reach);
  match_ = matcher_.match(map_, guess_W, settings_.prior);
  if (match_.share >= settings_.lost) return;
  const ScanMatch again = matcher_.match(map_, matcher_.search(map_, guess_W), settings_.prior);
  if (again.share > match_.share) match_ = again;
}

bool Mapper::is_new() const {
  if (!entered_W_) return true;
  const Pose2 step = pose_step(*entered_W_, match_.pose_W);
  return step.position().norm() >= settings_.new_way ||
         std::abs(step.heading) >= settings_.new_turn;
}

}  // namespace algo
