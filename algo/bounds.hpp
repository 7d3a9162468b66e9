// algo/bounds.hpp: axis-aligned bounding boxes.
#pragma once

#include <Eigen/Geometry>

#include "algo/obstacle.hpp"

namespace algo {

/// The smallest axis-aligned box in W that holds `obstacle`.
inline Eigen::AlignedBox2d bounds_W(const Obstacle& obstacle) {
  Eigen::AlignedBox2d box;
  if (const auto* cylinder = std::get_if<Cylinder>(&obstacle.shape)) {
    const Vec2 edge(cylinder->radius, cylinder->radius);
    box.extend(obstacle.pose_W.position() - edge).extend(obstacle.pose_W.position() + edge);
  }
  for (const Vec2& corner : outline_W(obstacle)) box.extend(corner);
  return box;
}

}  // namespace algo
