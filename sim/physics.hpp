// sim/physics.hpp: the floor, and the obstacles near a robot, in a Bullet world.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <btBulletDynamicsCommon.h>

#include "algo/obstacle.hpp"
#include "sim/bullet_ptr.hpp"
#include "sim/ground_body.hpp"
#include "sim/obstacle_set.hpp"

namespace sim {

/// Owns Bullet's world, its floor at z = 0 and the bodies of each obstacle. A base adds its own
/// bodies and constraints to world(). It must remove them before restart() and before the Physics
/// ends.
///
/// Only obstacles near the robot are in the world, so that a step costs as much with twenty
/// obstacles as with a thousand. Rays never use Bullet.
class Physics {
 public:
  static constexpr double kMargin = 0.001;  // [m] the default of 0.04 rounds small edges off
  static constexpr double kGravity = 9.81;  // [m/s2]

  /// What the world can hold besides rigid bodies.
  enum class Bodies : std::uint8_t { Rigid, Jointed };

  explicit Physics(Bodies bodies = Bodies::Rigid) : bodies_kind_(bodies) { build(); }
  ~Physics();
  Physics(const Physics&) = delete;
  Physics& operator=(const Physics&) = delete;

  btDiscreteDynamicsWorld& world() { return *world_; }
  btRigidBody& floor() { return *floor_; }
  /// True for the bodies of ramps and trenches.
  static bool is_ground(const btCollisionObject& body);

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
  /// A solid in Bullet, fixed to an obstacle.
  struct Part {
    BulletPtr<btCollisionShape> shape{};
    BulletPtr<btCollisionObject> object{};
    btTransform at{};  // in the obstacle's frame on the floor
  };
  /// An obstacle's Bullet bodies, in the world or not.
  struct Body {
    std::vector<Part> parts{};
    bool present = false;
    bool ground = false;
    std::uint32_t id = 0;
  };
  struct Dispatcher : btCollisionDispatcher {
    using btCollisionDispatcher::btCollisionDispatcher;
    const std::vector<Hole>* holes = nullptr;  // null: before the first gather()
  };

  void build();
  void empty();
  static void place(Body& body, const algo::Pose2& pose_W);
  void withdraw(Body& body);
  static void meet(btBroadphasePair& pair,
                   btCollisionDispatcher& dispatcher,
                   const btDispatcherInfo& info);
  void choose_iterations();

  Bodies bodies_kind_;
  // In order of construction; destroyed in reverse.
  BulletPtr<btDefaultCollisionConfiguration> configuration_{};
  BulletPtr<Dispatcher> dispatcher_{};
  BulletPtr<btDbvtBroadphase> broadphase_{};
  BulletPtr<btSequentialImpulseConstraintSolver> solver_{};
  BulletPtr<btDiscreteDynamicsWorld> world_{};
  BulletPtr<btStaticPlaneShape> floor_shape_{};
  BulletPtr<btRigidBody> floor_{};
  std::vector<Body> bodies_{};  // in the order of the ObstacleSet
  std::vector<Hole> holes_{};   // the trenches' own
  std::size_t grounds_ = 0;     // bodies that are ramps or trenches

  algo::Vec2 gathered_at_{0, 0};  // where the near obstacles were last selected
  bool gathered_ = false;
};

}  // namespace sim
