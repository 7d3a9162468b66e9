// sim/obstacle_body.hpp: planar obstacles as solid bodies on the floor.
#pragma once

#include <btBulletCollisionCommon.h>

#include "algo/obstacle.hpp"
#include "sim/bullet_ptr.hpp"

namespace sim {

/// Shape of an obstacle about its own middle: cylinder, box, or for a polygon a convex hull, whose
/// surface Bullet rounds off by `margin` [m]; good for contacts, not for ranges.
BulletPtr<btCollisionShape> obstacle_shape(const algo::Obstacle& obstacle, double margin);

/// Where its middle is: half its height over the floor.
btTransform obstacle_transform(const algo::Obstacle& obstacle);

}  // namespace sim
