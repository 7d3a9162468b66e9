// sim/physics.cpp: Bullet's world, and the selection of obstacles in it.
#include "sim/physics.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/obstacle_body.hpp"

namespace sim {
namespace {

constexpr int kPooledPairs = 64;
constexpr double kGravity = 9.81;  // [m/s2]
constexpr int kIterations = 10;    // enough on a flat floor
constexpr double kRegather = 0.5;  // [m] driven before the near obstacles are selected anew
constexpr double kSideways = 0.1;  // z of a contact's normal below which it supports nothing
constexpr int kHullShape = 0;

/// Drops contacts at the sides of a wheel. A support ball replaces the wheel and extends farther
/// sideways than it; only the hull touches obstacles beside the robot. The user index of a chassis
/// is the number of its last wheel; every other body has -1.
void drop_wheel_sides(btBroadphasePair& pair,
                      btCollisionDispatcher& dispatcher,
                      const btDispatcherInfo& info) {
  btCollisionDispatcher::defaultNearCallback(pair, dispatcher, info);
  if (pair.m_algorithm == nullptr) return;
  static thread_local btManifoldArray manifolds;  // keeps its memory
  manifolds.resize(0);
  pair.m_algorithm->getAllContactManifolds(manifolds);
  for (int m = 0; m < manifolds.size(); ++m) {
    btPersistentManifold& manifold = *manifolds[m];
    const int last_wheel =
        std::max(manifold.getBody0()->getUserIndex(), manifold.getBody1()->getUserIndex());
    const bool first = manifold.getBody0()->getUserIndex() == last_wheel;
    for (int c = manifold.getNumContacts() - 1; c >= 0; --c) {
      const btManifoldPoint& point = manifold.getContactPoint(c);
      const int part = first ? point.m_index0 : point.m_index1;
      const bool wheel = part > kHullShape && part <= last_wheel;
      if (wheel && std::abs(point.m_normalWorldOnB.z()) < kSideways) manifold.removeContactPoint(c);
    }
  }
}

}  // namespace

Physics::~Physics() {
  empty();
}

void Physics::build() {
  // Bullet's default reserves room for thousands of pairs in contact, seven megabytes per world.
  // Pairs beyond the room come from the heap.
  btDefaultCollisionConstructionInfo room;
  room.m_defaultMaxPersistentManifoldPoolSize = kPooledPairs;
  room.m_defaultMaxCollisionAlgorithmPoolSize = kPooledPairs;
  configuration_ = make_bullet<btDefaultCollisionConfiguration>(room);
  dispatcher_ = make_bullet<btCollisionDispatcher>(configuration_.get());
  dispatcher_->setNearCallback(drop_wheel_sides);
  broadphase_ = make_bullet<btDbvtBroadphase>();
  solver_ = make_bullet<btSequentialImpulseConstraintSolver>();
  world_ = make_bullet<btDiscreteDynamicsWorld>(
      dispatcher_.get(), broadphase_.get(), solver_.get(), configuration_.get());
  world_->setGravity(btVector3(0, 0, -kGravity));
  world_->setForceUpdateAllAabbs(false);
  world_->getSolverInfo().m_numIterations = kIterations;
  world_->getSolverInfo().m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;

  floor_shape_ = make_bullet<btStaticPlaneShape>(btVector3(0, 0, 1), 0);
  btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, floor_shape_.get());
  info.m_friction = 0;
  floor_ = make_bullet<btRigidBody>(info);
  world_->addRigidBody(floor_.get());
  gathered_ = false;
}

void Physics::empty() {
  for (Body& body : bodies_) withdraw(body);
  world_->removeRigidBody(floor_.get());
}

void Physics::restart() {
  empty();
  floor_.reset();
  world_.reset();
  solver_.reset();
  broadphase_.reset();
  dispatcher_.reset();
  build();
}

void Physics::set_down(btRigidBody& body) {
  broadphase_->getOverlappingPairCache()->cleanProxyFromPairs(body.getBroadphaseHandle(),
                                                              dispatcher_.get());
  world_->updateSingleAabb(&body);
  gathered_ = false;
}

void Physics::added(const algo::Obstacle& obstacle) {
  Body body;
  body.shape = obstacle_shape(obstacle, kMargin);
  body.object = make_bullet<btCollisionObject>();
  body.object->setCollisionShape(body.shape.get());
  body.object->setCollisionFlags(btCollisionObject::CF_STATIC_OBJECT);
  body.object->setFriction(0);
  body.object->setWorldTransform(obstacle_transform(obstacle));
  bodies_.push_back(std::move(body));
  gathered_ = false;
}

void Physics::moved(std::size_t index, const algo::Obstacle& obstacle) {
  withdraw(bodies_[index]);
  bodies_[index].object->setWorldTransform(obstacle_transform(obstacle));
  gathered_ = false;
}

void Physics::removed(std::size_t index) {
  withdraw(bodies_[index]);
  bodies_.erase(bodies_.begin() + static_cast<std::ptrdiff_t>(index));
  gathered_ = false;
}

void Physics::gather(const ObstacleSet& obstacles, const algo::Vec2& here_W, double reach) {
  if (gathered_ && (here_W - gathered_at_).squaredNorm() < kRegather * kRegather) return;
  gathered_ = true;
  gathered_at_ = here_W;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    Body& body = bodies_[k];
    const bool near = obstacles.may_reach(k, here_W, reach);
    if (near && !body.present) {
      world_->addCollisionObject(body.object.get(),
                                 btBroadphaseProxy::StaticFilter,
                                 btBroadphaseProxy::AllFilter ^ btBroadphaseProxy::StaticFilter);
      body.present = true;
    } else if (!near) {
      withdraw(body);
    }
  }
}

void Physics::withdraw(Body& body) {
  if (body.present) world_->removeCollisionObject(body.object.get());
  body.present = false;
}

}  // namespace sim
