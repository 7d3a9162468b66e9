// tests/sim/reference_world.hpp: the room W(K) of the benchmarks and an analytic ray oracle without
// code shared with the caster.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "algo/obstacle.hpp"

namespace reference {

inline double uniform(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11) * 0x1.0p-53;
}

/// Square room of side 10 sqrt(K / 20) m, 0.2 m walls, K obstacles, half boxes and half cylinders,
/// half-sizes 0.10 to 0.35 m, none within 1.2 m of the centre.
inline std::vector<algo::Obstacle> room(std::uint32_t count, std::uint64_t seed = 1) {
  std::mt19937_64 random(seed);
  const double half = 5 * std::sqrt(count / 20.0);
  std::vector<algo::Obstacle> world;
  for (std::uint32_t i = 0; i < count; ++i) {
    algo::Obstacle obstacle;
    obstacle.id = i + 1;
    do {
      obstacle.pose_W = {uniform(random, -half + 0.5, half - 0.5),
                         uniform(random, -half + 0.5, half - 0.5),
                         uniform(random, -std::numbers::pi, std::numbers::pi)};
    } while (obstacle.pose_W.position().norm() < 1.2 + 0.5);
    if (i % 2 == 0) {
      obstacle.shape = algo::Box{2 * uniform(random, 0.10, 0.35), 2 * uniform(random, 0.10, 0.35)};
    } else {
      obstacle.shape = algo::Cylinder{uniform(random, 0.10, 0.35)};
    }
    world.push_back(obstacle);
  }
  for (std::uint32_t side = 0; side < 4; ++side) {
    const double bearing = side * std::numbers::pi / 2;
    algo::Obstacle wall;
    wall.id = count + 1 + side;
    const algo::Vec2 middle = (half + 0.1) * algo::direction(bearing);
    wall.pose_W = {middle.x(), middle.y(), algo::wrap_angle(bearing + std::numbers::pi / 2)};
    wall.shape = algo::Wall{2 * half + 0.4, 0.2};
    world.push_back(wall);
  }
  return world;
}

/// Range to a convex outline given in its own frame by half planes: the ray enters at the largest
/// entry and leaves at the least exit (Cyrus and Beck 1978).
inline double clip(const std::vector<algo::Vec2>& points,
                   const algo::Vec2& o,
                   const algo::Vec2& u) {
  double enter = 0;
  double leave = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const algo::Vec2 a = points[i];
    const algo::Vec2 b = points[(i + 1) % points.size()];
    const algo::Vec2 outward{b.y() - a.y(), a.x() - b.x()};
    const double height = outward.dot(o - a);  // above 0 outside
    const double speed = outward.dot(u);
    if (speed == 0) {
      if (height > 0) return std::numeric_limits<double>::infinity();
    } else if (speed < 0) {
      enter = std::max(enter, -height / speed);
    } else {
      leave = std::min(leave, -height / speed);
    }
  }
  return enter <= leave ? enter : std::numeric_limits<double>::infinity();
}

/// [m] Range of one ray to one obstacle, infinite when it misses, 0 from inside.
inline double range_to(const algo::Obstacle& obstacle, const algo::Vec2& origin_W, double angle) {
  // Into the obstacle's frame, where boxes and walls are axis-aligned.
  const double c = std::cos(obstacle.pose_W.heading);
  const double s = std::sin(obstacle.pose_W.heading);
  const algo::Vec2 d = origin_W - obstacle.pose_W.position();
  const algo::Vec2 o{c * d.x() + s * d.y(), c * d.y() - s * d.x()};
  const algo::Vec2 u = algo::direction(angle - obstacle.pose_W.heading);
  const auto rectangle = [&](double length, double width) {
    const double x = length / 2;
    const double y = width / 2;
    return clip({{-x, -y}, {x, -y}, {x, y}, {-x, y}}, o, u);
  };
  if (const auto* cylinder = std::get_if<algo::Cylinder>(&obstacle.shape)) {
    const double radius = cylinder->radius;
    if (o.norm() <= radius) return 0;
    const double along = -o.dot(u);
    const double miss = (o + along * u).norm();
    if (along < 0 || miss > radius) return std::numeric_limits<double>::infinity();
    return along - std::sqrt(radius * radius - miss * miss);
  }
  if (const auto* box = std::get_if<algo::Box>(&obstacle.shape)) {
    return rectangle(box->length, box->width);
  }
  if (const auto* wall = std::get_if<algo::Wall>(&obstacle.shape)) {
    return rectangle(wall->length, wall->thickness);
  }
  return clip(std::get<algo::Polygon>(obstacle.shape).points, o, u);
}

inline double range(const std::vector<algo::Obstacle>& world,
                    const algo::Vec2& origin_W,
                    double angle,
                    double range_max) {
  double nearest = range_max;
  for (const algo::Obstacle& obstacle : world) {
    nearest = std::min(nearest, range_to(obstacle, origin_W, angle));
  }
  return nearest;
}

/// `measured` equals the truth within `tolerance`, or the ray passes within 0.01 degree of a
/// silhouette and `measured` is the truth on either side of it.
inline bool agrees(const std::vector<algo::Obstacle>& world,
                   const algo::Vec2& origin_W,
                   double angle,
                   double range_max,
                   double measured,
                   double tolerance) {
  if (std::abs(range(world, origin_W, angle, range_max) - measured) <= tolerance) return true;
  const double side = 0.01 * std::numbers::pi / 180;
  const double left = range(world, origin_W, angle + side, range_max);
  const double right = range(world, origin_W, angle - side, range_max);
  const double low = std::min(left, right) - 0.02;
  const double high = std::max(left, right) + 0.02;
  return std::abs(left - right) > 0.02 && measured >= low && measured <= high &&
         (measured <= low + 0.04 || measured >= high - 0.04);
}

}  // namespace reference
