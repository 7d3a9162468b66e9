// sim/bullet_vehicle.cpp: chassis, contacts, parking.
#include "sim/bullet_vehicle.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "algo/diff_drive.hpp"

namespace sim {
namespace {

constexpr double kLoadLag = 0.010;         // [s] low-pass of the wheel loads
constexpr double kStillSpeed = 0.05;       // [m/s] below it parking begins
constexpr double kStillTurn = 0.10;        // [rad/s]
constexpr double kStillTime = 0.5;         // [s]
constexpr double kSettleTime = 0.5;        // [s] for the wheels to settle on the floor
constexpr double kContactTouching = 1e-4;  // [m] Bullet keeps contact points up to 0.02 m apart
constexpr int kHullPart = 0;

/// The wheel side of a part of the chassis, by sign.
int side_of(const btCompoundShape& chassis, int part, std::size_t wheels) {
  if (part <= kHullPart || part > static_cast<int>(2 * wheels)) return 0;
  return chassis.getChildTransform(part).getOrigin().y() > 0 ? 1 : -1;
}

}  // namespace

BulletVehicle::BulletVehicle(const RobotModel& robot, double period)
    : robot_(robot), substeps_(period) {}

BulletVehicle::~BulletVehicle() {
  take_down();
}

void BulletVehicle::take_down() {
  if (chassis_ == nullptr) return;
  physics_.world().removeConstraint(drive_.get());
  physics_.world().removeRigidBody(chassis_.get());
  drive_.reset();
  chassis_.reset();
}

void BulletVehicle::build_chassis() {
  const RobotModel& p = robot_;
  parts_.clear();
  chassis_shape_ = make_bullet<btCompoundShape>();
  const auto add = [this](BulletPtr<btCollisionShape> part, double x, double y, double z) {
    btTransform at = btTransform::getIdentity();
    at.setOrigin(btVector3(x, y, z - robot_.mass_height));  // the body's origin: centre of mass
    chassis_shape_->addChildShape(at, part.get());
    parts_.push_back(std::move(part));
  };
  const double hull_half = (p.hull_high - p.hull_low) / 2;
  BulletPtr<btCollisionShape> hull;
  if (p.round) {
    hull = make_bullet<btCylinderShapeZ>(btVector3(p.radius, p.radius, hull_half));
  } else {
    hull = make_bullet<btBoxShape>(btVector3(p.hull_length / 2, p.hull_width / 2, hull_half));
  }
  hull->setMargin(Physics::kMargin);
  add(std::move(hull), 0, 0, p.hull_low + hull_half);
  for (const double x : p.wheels) {
    for (const double y : {p.half_track, -p.half_track}) {
      add(make_bullet<btSphereShape>(p.wheel_radius), x, y, p.wheel_radius);
    }
  }
  for (const Caster& c : p.casters) {
    add(make_bullet<btSphereShape>(c.radius), c.x, c.y, c.radius + c.raised);
  }

  // The inertia of a solid box of the hull's size; the compound's own inertia is meaningless.
  const double xx = p.hull_length * p.hull_length;
  const double yy = p.hull_width * p.hull_width;
  const double zz = 4 * hull_half * hull_half;
  const btVector3 inertia = btVector3(yy + zz, xx + zz, xx + yy) * (p.mass / 12);
  btRigidBody::btRigidBodyConstructionInfo info(p.mass, nullptr, chassis_shape_.get(), inertia);
  info.m_friction = 0;
  info.m_startWorldTransform.setOrigin(btVector3(0, 0, p.mass_height));
  chassis_ = make_bullet<btRigidBody>(info);
  chassis_->setUserIndex(static_cast<int>(2 * p.wheels.size()));  // its last wheel; others have -1
  chassis_->setActivationState(DISABLE_DEACTIVATION);             // this class does the parking
  physics_.world().addRigidBody(chassis_.get());

  drive_ = make_bullet<DriveConstraint>(
      *chassis_,
      physics_.floor(),
      DriveConstraint::Layout{axle_of(p), p.half_track, p.mass_height, p.friction});
  physics_.world().addConstraint(drive_.get());
}

void BulletVehicle::reset(const algo::Pose2& start) {
  if (chassis_ != nullptr) {
    take_down();
    physics_.restart();
  }
  build_chassis();
  wanted_ = {};
  target_ = {};
  left_load_ = 0;
  right_load_ = 0;
  normal_ = btVector3(0, 0, 1);
  settle();

  // Settled at the origin with nothing around; now placed at the start in that posture.
  const btTransform settled = chassis_->getWorldTransform();
  const btMatrix3x3 turn(btQuaternion(btVector3(0, 0, 1), start.heading));
  btTransform at(turn * settled.getBasis());
  const btVector3 under = at.getBasis() * btVector3(0, 0, -robot_.mass_height);
  at.setOrigin(btVector3(start.x - under.x(), start.y - under.y(), settled.getOrigin().z()));
  chassis_->setWorldTransform(at);
  chassis_->setInterpolationWorldTransform(at);
  physics_.set_down(*chassis_);
  state_ = {};
  read_state();
  state_.pose_W = start;  // exactly
  state_.twist = {};
  parked_ = true;
  still_for_ = 0;
}

void BulletVehicle::settle() {
  const auto steps = static_cast<std::size_t>(std::ceil(kSettleTime / substeps_.length));
  for (std::size_t k = 0; k < steps; ++k) substep();
  chassis_->setLinearVelocity(btVector3(0, 0, 0));
  chassis_->setAngularVelocity(btVector3(0, 0, 0));
}

void BulletVehicle::drive(const algo::Twist2& command,
                          const ObstacleSet& obstacles,
                          PoseTrail& trail) {
  wanted_ = within_limits(command, robot_);
  if (wanted_ != algo::Twist2{}) {
    parked_ = false;
    still_for_ = 0;
  }
  if (!parked_) state_.contact = false;
  for (std::size_t k = 0; k < substeps_.count; ++k) {
    if (!parked_) {
      physics_.gather(obstacles, state_.pose_W.position(), robot_.radius + kNear);
      target_ = ramped(target_, wanted_, robot_, substeps_.length);
      substep();
      const algo::SideMotion sides = algo::sides_of(target_, robot_.half_track);
      const double per_step = substeps_.length / robot_.wheel_radius;
      state_.left_angle += sides.left * per_step;
      state_.right_angle += sides.right * per_step;
      read_state();
      update_parking();
    }
    trail.push(state_.pose_W);
  }
}

/// One step of the physics under `target_`.
void BulletVehicle::substep() {
  const algo::SideMotion sides = algo::sides_of(target_, robot_.half_track);
  drive_->set({sides.left, sides.right, left_load_, right_load_, normal_});
  physics_.step(substeps_.length);
  read_contacts();
}

/// Reads loads and contacts from the impulses just solved. During the set-up of the next step they
/// would be 0 at every new contact point, and a moving robot always has new ones.
void BulletVehicle::read_contacts() {
  double left = 0;
  double right = 0;
  btVector3 normal(0, 0, 0);
  btDispatcher& touches = *physics_.world().getDispatcher();
  for (int m = 0; m < touches.getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *touches.getManifoldByIndexInternal(m);
    const bool first = manifold.getBody0() == chassis_.get();
    for (int c = 0; c < manifold.getNumContacts(); ++c) {
      const btManifoldPoint& point = manifold.getContactPoint(c);
      const int part = first ? point.m_index0 : point.m_index1;
      const btVector3 up = first ? point.m_normalWorldOnB : -point.m_normalWorldOnB;
      const double impulse = point.getAppliedImpulse();
      if (part == kHullPart) {
        const bool touching = impulse > 0 || point.getDistance() < kContactTouching;
        if (touching && std::abs(up.z()) < 0.5) state_.contact = true;
        continue;
      }
      const int side = side_of(*chassis_shape_, part, robot_.wheels.size());
      if (side > 0) left += impulse;
      if (side < 0) right += impulse;
      if (side != 0) normal += up * impulse;
    }
  }
  const double share = substeps_.length / (kLoadLag + substeps_.length);
  left_load_ += share * (left / substeps_.length - left_load_);
  right_load_ += share * (right / substeps_.length - right_load_);
  if (normal.length2() > 0) normal_ = normal.normalized();
}

algo::Pose2 BulletVehicle::pose() const {
  const btTransform& at = chassis_->getWorldTransform();
  const btVector3 ground = at * btVector3(0, 0, -robot_.mass_height);
  const btVector3 ahead = at.getBasis().getColumn(0);
  return {ground.x(), ground.y(), std::atan2(ahead.y(), ahead.x())};
}

void BulletVehicle::read_state() {
  const btMatrix3x3& basis = chassis_->getWorldTransform().getBasis();
  state_.pose_W = pose();
  const btVector3 velocity =
      chassis_->getVelocityInLocalPoint(basis * btVector3(0, 0, -robot_.mass_height));
  const algo::Vec2 ahead = algo::direction(state_.pose_W.heading);
  state_.twist = {velocity.x() * ahead.x() + velocity.y() * ahead.y(),
                  chassis_->getAngularVelocity().z()};
  state_.roll = std::atan2(basis[2][1], basis[2][2]);
  state_.pitch = std::asin(std::clamp<double>(-basis[2][0], -1, 1));
}

/// Counts the time at rest, and parks after enough of it.
void BulletVehicle::update_parking() {
  const bool still = wanted_ == algo::Twist2{} && target_ == algo::Twist2{} &&
                     std::abs(state_.twist.v) < kStillSpeed &&
                     std::abs(state_.twist.omega) < kStillTurn;
  still_for_ = still ? still_for_ + substeps_.length : 0;
  if (still_for_ < kStillTime) return;
  parked_ = true;
  chassis_->setLinearVelocity(btVector3(0, 0, 0));
  chassis_->setAngularVelocity(btVector3(0, 0, 0));
  state_.twist = {};
}

}  // namespace sim
