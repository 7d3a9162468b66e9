// algo/geometry.cpp: positions of returns and the nearest of them, equations.md C.
#include "algo/geometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace algo {
namespace {

constexpr double kOnLimit = 1e-6;  // [rad] far below a beam's spacing, far above rounding

/// The first beam at or beyond `bearing`.
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
  return beams_between(scan, 0.0, kUsedHalfField + 2 * kOnLimit);  // includes the limit itself
}

namespace {

/// The smallest squared range of the Ok beams from `begin` to `end`; infinite if there is none.
/// Eight at a time, so that it vectorises. NaN is never the smallest.
double least_square(const LaserScan& scan, BeamSpan beams) {
  constexpr std::size_t kLanes = 8;
  constexpr double kNone = std::numeric_limits<double>::infinity();
  std::array<double, kLanes> least{};
  least.fill(kNone);
  const double* const ranges = scan.ranges.data();
  const Beam* const status = scan.status.data();
  const auto square = [=](std::size_t i) {
    return status[i] == Beam::Ok ? ranges[i] * ranges[i] : kNone;
  };
  std::size_t i = beams.begin;
  for (; i + kLanes <= beams.end; i += kLanes) {
    for (std::size_t k = 0; k < kLanes; ++k) {
      const double here = square(i + k);
      least[k] = here < least[k] ? here : least[k];
    }
  }
  for (; i < beams.end; ++i) least[0] = square(i) < least[0] ? square(i) : least[0];
  return *std::min_element(least.begin(), least.end());
}

/// For a scanner at the robot's centre: compares the ranges themselves, so that equal ones tie.
std::optional<NearestBeam> nearest_centred(const LaserScan& scan, BeamSpan beams) {
  const double least = least_square(scan, beams);
  if (std::isinf(least)) return std::nullopt;
  std::size_t found = beams.begin;
  while (scan.status[found] != Beam::Ok || scan.ranges[found] * scan.ranges[found] != least) {
    ++found;
  }
  return NearestBeam{found, std::sqrt(least)};
}

}  // namespace

std::optional<NearestBeam> nearest_beam(const LaserScan& scan, BeamSpan beams) {
  const Vec2 l = scan.mount_R.position();
  if (l.x() == 0 && l.y() == 0) return nearest_centred(scan, beams);
  double least = std::numeric_limits<double>::infinity();
  std::size_t found = beams.end;
  for (std::size_t i = beams.begin; i < beams.end; ++i) {
    if (scan.status[i] != Beam::Ok) continue;
    const double r = scan.ranges[i];
    // |l + r e|^2
    double square = r * r;
    square += 2 * r * l.dot(direction(scan.mount_R.heading + scan.angle(i))) + l.squaredNorm();
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
