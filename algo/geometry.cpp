// algo/geometry.cpp: beams to points and the nearest of them, equations.md C.
#include "algo/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace algo {
namespace {

constexpr double kOnLimit = 1e-6;  // [rad] far below a beam's spacing, far above rounding

/// First beam at or beyond `bearing`.
std::size_t first_beam(const LaserScan& scan, double bearing) {
  const double index = std::ceil((bearing - kOnLimit - scan.angle_min) / scan.angle_increment);
  return static_cast<std::size_t>(std::clamp(index, 0.0, static_cast<double>(scan.size())));
}

}  // namespace

Vec2 beam_point_R(const Pose2& mount_R, double bearing, double range) {
  return mount_R.position() + range * direction(mount_R.heading + bearing);
}

Vec2 beam_point_W(const Pose2& pose_W, const Pose2& mount_R, double bearing, double range) {
  return to_parent(pose_W, beam_point_R(mount_R, bearing, range));
}

BeamSpan beams_between(const LaserScan& scan, double from, double to) {
  const bool sound = std::isfinite(scan.angle_min) && std::isfinite(scan.angle_increment) &&
                     scan.angle_increment > 0;
  if (!sound || scan.size() == 0) return {};
  return {first_beam(scan, from), first_beam(scan, to)};
}

BeamSpan right_beams(const LaserScan& scan) {
  return beams_between(scan, -kUsedHalfField, 0.0);
}

BeamSpan left_beams(const LaserScan& scan) {
  return beams_between(scan, 0.0, kUsedHalfField + 2 * kOnLimit);  // the limit itself is used
}

std::optional<NearestBeam> nearest_beam(const LaserScan& scan, BeamSpan beams) {
  const Vec2 l = scan.mount_R.position();
  const bool offset = l.x() != 0 || l.y() != 0;
  double least = std::numeric_limits<double>::infinity();
  std::size_t found = beams.end;
  for (std::size_t i = beams.begin; i < beams.end; ++i) {
    if (scan.status[i] != Beam::Ok) continue;
    const double r = scan.ranges[i];
    // |l + r e|^2; without an offset the ranges themselves are compared, so that equal ranges tie.
    double square = r * r;
    if (offset) {
      square += 2 * r * l.dot(direction(scan.mount_R.heading + scan.angle(i))) + l.squaredNorm();
    }
    if (square < least) {
      least = square;
      found = i;
    }
  }
  if (found == beams.end) return std::nullopt;
  return NearestBeam{found, std::sqrt(std::max(least, 0.0))};
}

std::optional<NearestBeam> obstacle_check(const LaserScan& scan, double avoidance_range) {
  const auto hit = nearest_beam(scan, {right_beams(scan).begin, left_beams(scan).end});
  if (!hit || !(hit->distance < avoidance_range)) return std::nullopt;
  return hit;
}

std::optional<LiteralCheck> obstacle_check_literal(std::span<const double> ranges,
                                                   double avoidance_range) {
  constexpr std::size_t kFirst = 31;
  constexpr std::size_t kLast = 330;
  for (std::size_t i = kFirst; i <= kLast && i < ranges.size(); ++i) {
    if (ranges[i] < avoidance_range) return LiteralCheck{i, static_cast<int>(i / 2), ranges[i]};
  }
  return std::nullopt;
}

}  // namespace algo
