// sim/bullet_arm.cpp: the chain of links, its motors and its contacts.
#include "sim/bullet_arm.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include "sim/arm_reach.hpp"

namespace sim {
namespace {

constexpr double kStiffness = 0.3;      // of the motors' position, per step
constexpr double kGetsBack = 10;        // [rad/s2] at which a motor plans to brake on its way back
constexpr double kStandsFast = 1e-3;    // [rad, rad/s]
constexpr double kLeastInertia = 1e-4;  // [kg m2] a link without length has one too
constexpr double kTouching = 1e-4;      // [m]
constexpr int kArmGroup = 64;           // its own group of Bullet's filter

/// alpha_i of the table of Denavit and Hartenberg, docs/equations.md, "J. The arm".
constexpr std::array<double, algo::kArmJoints> kTwists{-std::numbers::pi / 2,
                                                       -std::numbers::pi / 2,
                                                       std::numbers::pi / 2,
                                                       -std::numbers::pi / 2,
                                                       std::numbers::pi / 2,
                                                       -std::numbers::pi / 2,
                                                       0};

/// Of a rod along `along`.
btVector3 rod_inertia(double mass, double length, double radius, const btVector3& along) {
  const double across = mass * (3 * radius * radius + length * length) / 12;
  const double about = mass * radius * radius / 2;
  btVector3 inertia;
  for (int k = 0; k < 3; ++k) {
    const double part = along[k] * along[k];
    inertia[k] = std::max(kLeastInertia, part * about + (1 - part) * across);
  }
  return inertia;
}

/// [rad/s] to get rid of a position's `error` [rad] in steps of `dt` [s]. No faster than a motor
/// can brake before it is there: a motor whose torque is at its limit would swing past, farther
/// each time.
double correction(double error, double dt) {
  const double most = std::sqrt(2 * kGetsBack * std::abs(error));
  return std::clamp(kStiffness * error / dt, -most, most);
}

btMultiBodyDynamicsWorld& multibody_world(Physics& physics) {
  return static_cast<btMultiBodyDynamicsWorld&>(physics.world());
}

}  // namespace

BulletArm::BulletArm(const ArmModel& arm, double mass_height, Physics& physics)
    : arm_(arm),
      shoulder_(arm.shoulder_R.x(), arm.shoulder_R.y(), arm.shoulder_R.z() - mass_height),
      physics_(physics) {
  build();
}

BulletArm::~BulletArm() {
  btMultiBodyDynamicsWorld& world = multibody_world(physics_);
  for (auto& motor : motors_) world.removeMultiBodyConstraint(motor.get());
  for (auto& collider : colliders_) world.removeCollisionObject(collider.get());
  world.removeMultiBody(body_.get());
}

void BulletArm::build() {
  constexpr int kJoints = static_cast<int>(algo::kArmJoints);
  const std::array<double, algo::kArmJoints> d{0, 0, arm_.upper_arm, 0, arm_.forearm, 0, arm_.hand};
  const std::array<double, algo::kArmJoints> a{0, 0, 0, arm_.elbow_offset, 0, 0, 0};
  body_ = make_bullet<btMultiBody>(kJoints, 0, btVector3(0, 0, 0), true, false);
  btVector3 before(0, 0, 0);  // centre of mass of the parent, in its DH frame
  for (int k = 0; k < kJoints; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const btQuaternion back(btVector3(1, 0, 0), -kTwists[i]);
    const btVector3 step =
        quatRotate(back, btVector3(a[i], 0, d[i]));  // from the joint, in frame i
    centre_[i] = -step / 2;
    double mass = arm_.masses[i];
    btVector3 along = step.length() > 0 ? step.normalized() : btVector3(0, 0, 1);
    if (i + 1 == algo::kArmJoints && arm_.payload > 0) {  // at the hand's end
      centre_[i] *= mass / (mass + arm_.payload);
      mass += arm_.payload;
    }
    body_->setupRevolute(k,
                         mass,
                         rod_inertia(mass, step.length(), arm_.link_radius, along),
                         k - 1,
                         back,
                         quatRotate(back, btVector3(0, 0, 1)),
                         -before,
                         step + centre_[i],
                         true);
    before = centre_[i];
  }
  body_->finalizeMultiDof();
  body_->setHasSelfCollision(false);
  body_->setLinearDamping(0);
  body_->setAngularDamping(0);
  body_->setUseGyroTerm(true);
  for (int k = 0; k < kJoints; ++k) {
    target_[static_cast<std::size_t>(k)] = arm_.begins()[static_cast<std::size_t>(k)];
    body_->setJointPos(k, arm_.begins()[static_cast<std::size_t>(k)]);
  }
  btMultiBodyDynamicsWorld& world = multibody_world(physics_);
  world.addMultiBody(body_.get());
  // Bullet solves a motor in the island of its link's collider or of the parent's: the first joint
  // has neither but for this one, which meets nothing.
  add_collider(1, {0, 0, 0}, {0, 0, 0}, algo::BodyLink::Mast);
  const btVector3 elbow(-arm_.elbow_offset, 0, 0);
  add_collider(2, {0, 0, 0}, {0, 0, arm_.upper_arm}, algo::BodyLink::UpperArm);
  add_collider(4, elbow, {0, 0, arm_.forearm}, algo::BodyLink::Forearm);
  add_collider(6, {0, 0, 0}, {0, 0, arm_.hand}, algo::BodyLink::Hand);
  for (std::size_t i = 0; i < motors_.size(); ++i) {
    motors_[i] = make_bullet<btMultiBodyJointMotor>(body_.get(), static_cast<int>(i), 0.0, 0.0);
    motors_[i]->finalizeMultiDof();
    world.addMultiBodyConstraint(motors_[i].get());
  }
}

/// A rounded rod in the frame behind the first `joints` joints.
void BulletArm::add_collider(std::size_t joints,
                             const btVector3& from,
                             const btVector3& to,
                             algo::BodyLink link) {
  const btVector3 way = to - from;
  const btVector3 along = way.fuzzyZero() ? btVector3(0, 0, 1) : way.normalized();
  auto rod = make_bullet<btCapsuleShapeZ>(arm_.link_radius, way.length());
  auto shape = make_bullet<btCompoundShape>();
  const btTransform at(shortestArcQuat(btVector3(0, 0, 1), along),
                       (from + to) / 2 - centre_[joints - 1]);
  shape->addChildShape(at, rod.get());
  const int index = static_cast<int>(joints) - 1;
  auto collider = make_bullet<btMultiBodyLinkCollider>(body_.get(), index);
  collider->setCollisionShape(shape.get());
  collider->setFriction(0);
  collider->setUserIndex2(-1);
  collider->setUserIndex3(static_cast<int>(link));
  body_->getLink(index).m_collider = collider.get();
  multibody_world(physics_).addCollisionObject(
      collider.get(), kArmGroup, way.fuzzyZero() ? 0 : btBroadphaseProxy::StaticFilter);
  shapes_.push_back(std::move(rod));
  shapes_.push_back(std::move(shape));
  colliders_.push_back(std::move(collider));
}

btTransform BulletArm::shoulder_W(const btRigidBody& chassis) const {
  return chassis.getWorldTransform() *
         btTransform(btQuaternion(btVector3(0, 0, 1), arm_.heading), shoulder_);
}

void BulletArm::place(const btRigidBody& chassis) {
  body_->setBaseWorldTransform(shoulder_W(chassis));
  body_->setBaseVel(
      chassis.getVelocityInLocalPoint(chassis.getWorldTransform().getBasis() * shoulder_));
  body_->setBaseOmega(chassis.getAngularVelocity());
  btAlignedObjectArray<btQuaternion> turns;
  btAlignedObjectArray<btVector3> places;
  body_->forwardKinematics(turns, places);
  body_->updateCollisionObjectWorldTransforms(turns, places);
}

void BulletArm::prepare(const btRigidBody& chassis, const algo::JointValues& rates, double dt) {
  place(chassis);
  const algo::JointValues turned = within_limits(rates, target_, arm_, dt);
  for (std::size_t i = 0; i < motors_.size(); ++i) {
    target_[i] += turned[i] * dt;
    const double error = target_[i] - body_->getJointPos(static_cast<int>(i));
    motors_[i]->setVelocityTarget(turned[i] + correction(error, dt), 1);
    motors_[i]->setMaxAppliedImpulse(arm_.torques[i] * dt);  // the limit is an impulse
  }
}

algo::JointValues BulletArm::position() const {
  algo::JointValues out{};
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = body_->getJointPos(static_cast<int>(i));
  return out;
}

bool BulletArm::settled() const {
  for (std::size_t i = 0; i < motors_.size(); ++i) {
    const int joint = static_cast<int>(i);
    if (std::abs(body_->getJointVel(joint)) > kStandsFast) return false;
    if (std::abs(body_->getJointPos(joint) - target_[i]) > kStandsFast) return false;
  }
  return true;
}

std::optional<algo::BodyLink> BulletArm::touched() const {
  btDispatcher& touches = *physics_.world().getDispatcher();
  for (int m = 0; m < touches.getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *touches.getManifoldByIndexInternal(m);
    const auto* link = btMultiBodyLinkCollider::upcast(manifold.getBody0());
    if (link == nullptr) link = btMultiBodyLinkCollider::upcast(manifold.getBody1());
    if (link == nullptr) continue;
    for (int c = 0; c < manifold.getNumContacts(); ++c) {
      if (manifold.getContactPoint(c).getDistance() < kTouching) {
        return static_cast<algo::BodyLink>(link->getUserIndex3());
      }
    }
  }
  return std::nullopt;
}

algo::Pose3 BulletArm::frame_W(std::size_t joints) const {
  btTransform at = body_->getBaseWorldTransform();
  if (joints > 0) {
    const btTransform& link = body_->getLink(static_cast<int>(joints) - 1).m_cachedWorldTransform;
    at = btTransform(link.getBasis(), link * -centre_[joints - 1]);
  }
  algo::Pose3 pose = algo::Pose3::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      pose.linear()(row, column) = at.getBasis()[row][column];
    }
    pose.translation()[row] = at.getOrigin()[row];
  }
  return pose;
}

}  // namespace sim
