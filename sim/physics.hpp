// sim/physics.hpp: the floor, and the obstacles near a robot, in a Bullet world.
#pragma once

#include <cstddef>
#include <vector>

#include <btBulletDynamicsCommon.h>

#include "algo/obstacle.hpp"
#include "sim/bullet_ptr.hpp"
#include "sim/obstacle_set.hpp"

namespace sim {

/// Owns Bullet's world, its floor at z = 0 and a body for each obstacle. A base adds its own bodies
/// and constraints to world(). It must remove them before restart() and before the Physics ends.
///
/// Only obstacles near the robot are in the world, so that a step costs as much with twenty
/// obstacles as with a thousand. Rays never use Bullet.
class Physics {
 public:
  static constexpr double kMargin = 0.001;  // [m] the default of 0.04 rounds small edges off

  Physics() { build(); }
  ~Physics();
  Physics(const Physics&) = delete;
  Physics& operator=(const Physics&) = delete;

  btDiscreteDynamicsWorld& world() { return *world_; }
  btRigidBody& floor() { return *floor_; }

  /// Creates an empty world for the same obstacles, without any state of earlier steps.
  void restart();
  void step(double seconds) { world_->stepSimulation(seconds, 0); }
  /// Drops the cached contacts of `body`, which was placed elsewhere.
  void set_down(btRigidBody& body);

  /// Changes of the obstacles; `index` is the index in the ObstacleSet.
  void added(const algo::Obstacle& obstacle);
  void moved(std::size_t index, const algo::Obstacle& obstacle);
  void removed(std::size_t index);
  /// Adds the obstacles within `reach` [m] of `here_W` to the world and removes the others.
  void gather(const ObstacleSet& obstacles, const algo::Vec2& here_W, double reach);

 private:
  /// An obstacle's Bullet body, in the world or not.
  struct Body {
    BulletPtr<btCollisionShape> shape{};
    BulletPtr<btCollisionObject> object{};
    bool present = false;
  };

  void build();
  void empty();
  void withdraw(Body& body);

  // In order of construction; destroyed in reverse.
  BulletPtr<btDefaultCollisionConfiguration> configuration_{};
  BulletPtr<btCollisionDispatcher> dispatcher_{};
  BulletPtr<btDbvtBroadphase> broadphase_{};
  BulletPtr<btSequentialImpulseConstraintSolver> solver_{};
  BulletPtr<btDiscreteDynamicsWorld> world_{};
  BulletPtr<btStaticPlaneShape> floor_shape_{};
  BulletPtr<btRigidBody> floor_{};
  std::vector<Body> bodies_{};  // in the order of the ObstacleSet

  algo::Vec2 gathered_at_{0, 0};  // where the near obstacles were last selected
  bool gathered_ = false;
};

}  // namespace sim
