// tests/sim/bullet_room.hpp: Bullet's own rays in double precision, the reference of the scans.
#pragma once

#include <cstddef>
#include <vector>

#include <btBulletCollisionCommon.h>

#include "algo/obstacle.hpp"
#include "sim/bullet_ptr.hpp"
#include "sim/obstacle_body.hpp"

namespace reference {

/// The pose of an obstacle's centre: half its height above the floor.
inline btTransform transform_of(const algo::Obstacle& obstacle) {
  const algo::Pose2& pose = obstacle.pose_W;
  return btTransform(btQuaternion(btVector3(0, 0, 1), pose.heading),
                     btVector3(pose.x, pose.y, (obstacle.bottom + obstacle.height) / 2));
}

/// A room as Bullet collision objects.
class BulletRoom {
 public:
  static constexpr double kPlane = 0.35;  // [m] height of the rays

  explicit BulletRoom(const std::vector<algo::Obstacle>& obstacles) {
    for (const algo::Obstacle& obstacle : obstacles) {
      shapes_.push_back(sim::obstacle_shape(obstacle, 0.001));
      objects_.push_back(sim::make_bullet<btCollisionObject>());
      objects_.back()->setCollisionShape(shapes_.back().get());
      objects_.back()->setWorldTransform(transform_of(obstacle));
      world_.addCollisionObject(objects_.back().get());
    }
  }
  ~BulletRoom() {
    for (const auto& object : objects_) world_.removeCollisionObject(object.get());
  }
  BulletRoom(const BulletRoom&) = delete;
  BulletRoom& operator=(const BulletRoom&) = delete;

  /// Moves the obstacle with number `index` to the pose of `obstacle`.
  void move(std::size_t index, const algo::Obstacle& obstacle) {
    objects_[index]->setWorldTransform(transform_of(obstacle));
    world_.updateSingleAabb(objects_[index].get());
  }

  /// [m] Range of one ray, `range_max` without a hit.
  double range(const algo::Vec2& origin, double angle, double range_max) const {
    const algo::Vec2 end = origin + range_max * algo::direction(angle);
    const btVector3 from(origin.x(), origin.y(), kPlane);
    const btVector3 to(end.x(), end.y(), kPlane);
    btCollisionWorld::ClosestRayResultCallback hit(from, to);
    world_.rayTest(from, to, hit);
    return hit.hasHit() ? hit.m_closestHitFraction * range_max : range_max;
  }

 private:
  btDefaultCollisionConfiguration configuration_{};
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_{};
  btCollisionWorld world_{&dispatcher_, &broadphase_, &configuration_};
  std::vector<sim::BulletPtr<btCollisionShape>> shapes_{};
  std::vector<sim::BulletPtr<btCollisionObject>> objects_{};
};

}  // namespace reference
