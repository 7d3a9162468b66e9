// sim/obstacle_body.cpp: Bullet shapes of obstacles.
#include "sim/obstacle_body.hpp"

namespace sim {

BulletPtr<btCollisionShape> obstacle_shape(const algo::Obstacle& obstacle, double margin) {
  const double half = (obstacle.height - obstacle.bottom) / 2;
  BulletPtr<btCollisionShape> shape;
  if (const auto* cylinder = std::get_if<algo::Cylinder>(&obstacle.shape)) {
    shape = make_bullet<btCylinderShapeZ>(btVector3(cylinder->radius, cylinder->radius, half));
  } else if (const auto* box = std::get_if<algo::Box>(&obstacle.shape)) {
    shape = make_bullet<btBoxShape>(btVector3(box->length / 2, box->width / 2, half));
  } else if (const auto* wall = std::get_if<algo::Wall>(&obstacle.shape)) {
    shape = make_bullet<btBoxShape>(btVector3(wall->length / 2, wall->thickness / 2, half));
  } else {
    auto hull = make_bullet<btConvexHullShape>();
    for (const algo::Vec2& p : std::get<algo::Polygon>(obstacle.shape).points) {
      hull->addPoint(btVector3(p.x(), p.y(), -half), false);
      hull->addPoint(btVector3(p.x(), p.y(), half), false);
    }
    hull->recalcLocalAabb();
    shape = std::move(hull);
  }
  shape->setMargin(margin);
  return shape;
}

}  // namespace sim
