// algo/hull.hpp: the outline of a robot in the plane.
#pragma once

#include <algorithm>
#include <cmath>

#include "algo/types.hpp"

namespace algo {

/// A rectangle centred on R, or a disc when half_length is 0.
struct Hull {
  double radius = 0;       // [m] of the disc, or of the rectangle's circumscribed circle
  double half_length = 0;  // [m] along R's x
  double half_width = 0;   // [m] along R's y
  bool is_disc() const { return !(half_length > 0); }
};

/// [m] Distance from the centre to the outline of `hull` at `bearing` [rad, in R].
inline double outline_at(const Hull& hull, double bearing) {
  if (hull.is_disc()) return hull.radius;
  const Vec2 way = direction(bearing).cwiseAbs();
  return std::min(hull.half_length / way.x(), hull.half_width / way.y());
}

/// [m] Distance from `p` to the outline of a rectangle about the origin; negative inside.
inline double to_rectangle(const Vec2& p, double half_length, double half_width) {
  const double dx = std::abs(p.x()) - half_length;
  const double dy = std::abs(p.y()) - half_width;
  if (dx <= 0 && dy <= 0) return std::max(dx, dy);
  return std::hypot(std::max(dx, 0.0), std::max(dy, 0.0));
}

}  // namespace algo
