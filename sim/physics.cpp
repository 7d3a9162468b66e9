// sim/physics.cpp: Bullet's world, and the selection of obstacles in it.
#include "sim/physics.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include "sim/obstacle_body.hpp"

namespace sim {
namespace {

constexpr int kPooledPairs = 64;
constexpr int kIterations = 10;  // enough on a flat floor
constexpr int kMoreIterations = 50;
constexpr double kRegather = 0.5;  // [m] driven before the near obstacles are selected anew
constexpr double kSideways = 0.1;  // z of a contact's normal below which it supports nothing
constexpr int kHullShape = 0;

// The user indices of a body. Without a mark, Bullet sets each to -1.
//   1: of a chassis, the number of its last wheel
//   2: kFloorMark, or kGroundMark for the parts of ramps and trenches
//   3: of a part of a trench, the trench's id
constexpr int kFloorMark = 0;
constexpr int kGroundMark = 1;

bool is_chassis(const btCollisionObject& body) {
  return body.getUserIndex() >= 0;
}

/// Drops contacts at the sides of a wheel. A support ball replaces the wheel and extends farther
/// sideways than it; only the hull touches obstacles beside the robot.
void drop_wheel_sides(btPersistentManifold& manifold) {
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

/// Drops the contacts with `ground` in the holes: the floor does not know of them, and the rims of
/// a trench may lie in another. The floor ends a little outside a hole, where the rims carry on, so
/// that a wheel pressed against the side of a trench never touches the floor below its surface.
void drop_in_holes(btPersistentManifold& manifold,
                   const btCollisionObject& ground,
                   const std::vector<Hole>& holes) {
  const bool floor = ground.getUserIndex2() == kFloorMark;
  for (const Hole& hole : holes) {
    if (!floor && ground.getUserIndex3() == static_cast<int>(hole.id())) continue;
    for (int c = manifold.getNumContacts() - 1; c >= 0; --c) {
      const btVector3& at_W = manifold.getContactPoint(c).getPositionWorldOnB();
      if (hole.contains(at_W, floor)) manifold.removeContactPoint(c);
    }
  }
}

}  // namespace

/// Removes the contacts that a real robot does not have.
void Physics::meet(btBroadphasePair& pair,
                   btCollisionDispatcher& dispatcher,
                   const btDispatcherInfo& info) {
  btCollisionDispatcher::defaultNearCallback(pair, dispatcher, info);
  if (pair.m_algorithm == nullptr) return;
  static thread_local btManifoldArray manifolds;  // keeps its memory
  manifolds.resize(0);
  pair.m_algorithm->getAllContactManifolds(manifolds);
  const std::vector<Hole>* const holes = static_cast<const Dispatcher&>(dispatcher).holes;
  for (int m = 0; m < manifolds.size(); ++m) {
    btPersistentManifold& manifold = *manifolds[m];
    const btCollisionObject& other =
        is_chassis(*manifold.getBody0()) ? *manifold.getBody1() : *manifold.getBody0();
    // A wheel may well touch the riser of a step.
    if (other.getUserIndex2() != kGroundMark) drop_wheel_sides(manifold);
    const bool of_trench = other.getUserIndex2() == kFloorMark || other.getUserIndex3() != -1;
    if (holes != nullptr && of_trench) drop_in_holes(manifold, other, *holes);
  }
}

bool Physics::is_ground(const btCollisionObject& body) {
  return body.getUserIndex2() == kGroundMark;
}

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
  dispatcher_ = make_bullet<Dispatcher>(configuration_.get());
  dispatcher_->setNearCallback(meet);
  broadphase_ = make_bullet<btDbvtBroadphase>();
  if (bodies_kind_ == Bodies::Jointed) {
    auto solver = make_bullet<btMultiBodyConstraintSolver>();
    world_ = make_bullet<btMultiBodyDynamicsWorld>(
        dispatcher_.get(), broadphase_.get(), solver.get(), configuration_.get());
    solver_ = std::move(solver);
  } else {
    solver_ = make_bullet<btSequentialImpulseConstraintSolver>();
    world_ = make_bullet<btDiscreteDynamicsWorld>(
        dispatcher_.get(), broadphase_.get(), solver_.get(), configuration_.get());
  }
  world_->setGravity(btVector3(0, 0, -kGravity));
  world_->setForceUpdateAllAabbs(false);
  world_->getSolverInfo().m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
  choose_iterations();

  floor_shape_ = make_bullet<btStaticPlaneShape>(btVector3(0, 0, 1), 0);
  btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, floor_shape_.get());
  info.m_friction = 0;
  floor_ = make_bullet<btRigidBody>(info);
  floor_->setUserIndex2(kFloorMark);
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

void Physics::choose_iterations() {
  const bool many = grounds_ > 0 || bodies_kind_ == Bodies::Jointed;
  world_->getSolverInfo().m_numIterations = many ? kMoreIterations : kIterations;
}

void Physics::added(const algo::Obstacle& obstacle) {
  Body& body = bodies_.emplace_back();
  body.ground = algo::is_ground(obstacle);
  body.id = obstacle.id;
  const bool trench = std::holds_alternative<algo::Trench>(obstacle.shape);
  const auto add = [&body](BulletPtr<btCollisionShape> shape, const btTransform& at) {
    Part& part = body.parts.emplace_back();
    part.shape = std::move(shape);
    part.at = at;
    part.object = make_bullet<btCollisionObject>();
    part.object->setCollisionShape(part.shape.get());
    part.object->setCollisionFlags(btCollisionObject::CF_STATIC_OBJECT);
    part.object->setFriction(0);
  };
  if (body.ground) {
    for (GroundPart& part : ground_parts(obstacle, kMargin)) add(std::move(part.shape), part.at);
    for (Part& part : body.parts) {
      part.object->setUserIndex2(kGroundMark);
      if (trench) part.object->setUserIndex3(static_cast<int>(obstacle.id));
    }
    ++grounds_;
    choose_iterations();
  } else {
    add(obstacle_shape(obstacle, kMargin),
        btTransform(btQuaternion::getIdentity(),
                    btVector3(0, 0, (obstacle.bottom + obstacle.height) / 2)));
  }
  if (trench) holes_.emplace_back(obstacle);
  place(body, obstacle.pose_W);
  gathered_ = false;
}

void Physics::place(Body& body, const algo::Pose2& pose_W) {
  const btTransform on_floor(btQuaternion(btVector3(0, 0, 1), pose_W.heading),
                             btVector3(pose_W.x, pose_W.y, 0));
  for (Part& part : body.parts) part.object->setWorldTransform(on_floor * part.at);
}

void Physics::moved(std::size_t index, const algo::Obstacle& obstacle) {
  withdraw(bodies_[index]);
  place(bodies_[index], obstacle.pose_W);
  std::erase_if(holes_, [&](const Hole& hole) { return hole.id() == obstacle.id; });
  if (std::holds_alternative<algo::Trench>(obstacle.shape)) holes_.emplace_back(obstacle);
  gathered_ = false;
}

void Physics::removed(std::size_t index) {
  withdraw(bodies_[index]);
  std::erase_if(holes_, [id = bodies_[index].id](const Hole& hole) { return hole.id() == id; });
  if (bodies_[index].ground) --grounds_;
  choose_iterations();
  bodies_.erase(bodies_.begin() + static_cast<std::ptrdiff_t>(index));
  gathered_ = false;
}

void Physics::gather(const ObstacleSet& obstacles, const algo::Vec2& here_W, double reach) {
  if (gathered_ && (here_W - gathered_at_).squaredNorm() < kRegather * kRegather) return;
  gathered_ = true;
  gathered_at_ = here_W;
  dispatcher_->holes = holes_.empty() ? nullptr : &holes_;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    Body& body = bodies_[k];
    const bool near = obstacles.may_reach(k, here_W, reach);
    if (near && !body.present) {
      for (const Part& part : body.parts) {
        world_->addCollisionObject(part.object.get(),
                                   btBroadphaseProxy::StaticFilter,
                                   btBroadphaseProxy::AllFilter ^ btBroadphaseProxy::StaticFilter);
      }
      body.present = true;
    } else if (!near) {
      withdraw(body);
    }
  }
}

void Physics::withdraw(Body& body) {
  if (!body.present) return;
  for (const Part& part : body.parts) world_->removeCollisionObject(part.object.get());
  body.present = false;
}

}  // namespace sim
