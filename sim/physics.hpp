// sim/physics.hpp: the floor and the obstacles near a robot, in a Bullet world.
#pragma once

#include <cstddef>
#include <vector>

#include <btBulletDynamicsCommon.h>

#include "algo/obstacle.hpp"
#include "sim/bullet_ptr.hpp"
#include "sim/obstacle_set.hpp"

namespace sim {

/// Owns Bullet's world, its floor at z = 0 and a body for each obstacle. A base adds its own bodies
/// and constraints to world(), and takes them out before restart() and before its physics ends.
///
/// Only obstacles near the robot are in the world, so that a step costs the same among twenty and
/// among a thousand. Rays never go through Bullet.
class Physics {
 public:
  static constexpr double kMargin = 0.001;  // [m] the default of 0.04 rounds small edges away

  Physics() { build(); }
  ~Physics();
  Physics(const Physics&) = delete;
  Physics& operator=(const Physics&) = delete;

  btDiscreteDynamicsWorld& world() { return *world_; }
  btRigidBody& floor() { return *floor_; }

  /// An empty world of the same obstacles, which keeps nothing of the steps before.
  void restart();
  void step(double seconds) { world_->stepSimulation(seconds, 0); }
  /// Drops what is known of touches of `body`, which was set somewhere else.
  void set_down(btRigidBody& body);

  /// The obstacles as they change; `index` is the one in the ObstacleSet.
  void added(const algo::Obstacle& obstacle);
  void moved(std::size_t index, const algo::Obstacle& obstacle);
  void removed(std::size_t index);
  /// Brings the obstacles within `reach` [m] of `here_W` into the world and takes the others out.
  void gather(const ObstacleSet& obstacles, const algo::Vec2& here_W, double reach);

 private:
  /// An obstacle as Bullet sees it, whether or not it is in the world now.
  struct Body {
    BulletPtr<btCollisionShape> shape{};
    BulletPtr<btCollisionObject> object{};
    bool present = false;
  };

  void build();
  void empty();
  void withdraw(Body& body);

  // In the order of construction; torn down in reverse.
  BulletPtr<btDefaultCollisionConfiguration> configuration_{};
  BulletPtr<btCollisionDispatcher> dispatcher_{};
  BulletPtr<btDbvtBroadphase> broadphase_{};
  BulletPtr<btSequentialImpulseConstraintSolver> solver_{};
  BulletPtr<btDiscreteDynamicsWorld> world_{};
  BulletPtr<btStaticPlaneShape> floor_shape_{};
  BulletPtr<btRigidBody> floor_{};
  std::vector<Body> bodies_{};  // in the order of the ObstacleSet

  algo::Vec2 gathered_at_{0, 0};  // where the near obstacles were last chosen
  bool gathered_ = false;
};

}  // namespace sim
