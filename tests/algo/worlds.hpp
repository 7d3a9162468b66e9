// tests/algo/worlds.hpp: an exact scanner over circles and polygons, for tests without a simulator.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "algo/laser_scan.hpp"
#include "algo/types.hpp"

namespace worlds {

using algo::Vec2;

struct Circle {
  Vec2 centre{0, 0};
  double radius = 0;  // [m]
};

struct World {
  std::vector<Circle> circles{};
  std::vector<std::vector<Vec2>> polygons{};
};

constexpr double kNone = std::numeric_limits<double>::infinity();

/// [m] along unit vector `e` from `p` to the circle: the smaller root of |p + t e - c| = r.
inline double cast(const Vec2& p, const Vec2& e, const Circle& circle) {
  const Vec2 m = p - circle.centre;
  const double b = m.dot(e);
  const double inside = b * b - (m.squaredNorm() - circle.radius * circle.radius);
  if (inside < 0) return kNone;
  const double t = -b - std::sqrt(inside);
  return t >= 0 ? t : kNone;
}

inline double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// [m] along `e` from `p` to the segment a-b: p + t e = a + s (b - a).
inline double cast(const Vec2& p, const Vec2& e, const Vec2& a, const Vec2& b) {
  const double across = cross(e, b - a);
  if (across == 0) return kNone;
  const double t = cross(a - p, b - a) / across;
  const double s = cross(a - p, e) / across;
  return t >= 0 && s >= 0 && s <= 1 ? t : kNone;
}

inline double cast(const Vec2& p, const Vec2& e, const World& world) {
  double nearest = kNone;
  for (const Circle& circle : world.circles) nearest = std::min(nearest, cast(p, e, circle));
  for (const auto& polygon : world.polygons) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      nearest = std::min(nearest, cast(p, e, polygon[i], polygon[(i + 1) % polygon.size()]));
    }
  }
  return nearest;
}

/// [m] From `p` to the nearest surface; negative inside a circle.
inline double surface_distance(const Vec2& p, const World& world) {
  double nearest = kNone;
  for (const Circle& circle : world.circles) {
    nearest = std::min(nearest, (p - circle.centre).norm() - circle.radius);
  }
  for (const auto& polygon : world.polygons) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec2& a = polygon[i];
      const Vec2 edge = polygon[(i + 1) % polygon.size()] - a;
      const double t = std::clamp((p - a).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
      nearest = std::min(nearest, (p - a - t * edge).norm());
    }
  }
  return nearest;
}

/// Flat-time, noise-free: 361 beams of 0.5 degree from the robot's centre.
inline void scan_world(const algo::Pose2& pose,
                       const World& world,
                       double range_max,
                       algo::LaserScan& scan) {
  constexpr double kDegree = std::numbers::pi / 180;
  scan.range_max = range_max;
  scan.angle_min = -90 * kDegree;
  scan.angle_increment = 0.5 * kDegree;
  scan.resize(361);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Vec2 e = algo::direction(pose.heading + scan.angle(i));
    const double range = cast(pose.position(), e, world);
    if (range < range_max) {
      scan.set_ok(i, range);
    } else {
      scan.set_free(i);
    }
  }
}

}  // namespace worlds
