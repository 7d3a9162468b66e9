// sim/obstacle_body.hpp: planar obstacles as solid bodies on the floor.
#pragma once

#include <btBulletCollisionCommon.h>

#include "algo/obstacle.hpp"
#include "sim/bullet_ptr.hpp"

namespace sim {

/// The shape of an obstacle about its own centre: cylinder, box, or a convex hull for a polygon.
/// Bullet rounds the hull's surface by `margin` [m]; good for contacts, not for ranges.
BulletPtr<btCollisionShape> obstacle_shape(const algo::Obstacle& obstacle, double margin);

}  // namespace sim
