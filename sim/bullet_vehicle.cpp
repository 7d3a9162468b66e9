// sim/bullet_vehicle.cpp: chassis, contacts, parking.
#include "sim/bullet_vehicle.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>

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
constexpr double kSlowTilt = 0.02;    // [rad/s] a robot that tips over does so faster before long
constexpr double kSlowSlide = 0.005;  // [m/s]
constexpr double kDropUnmeasured = 0.05;  // [m] down an edge is a fall if its limit is not known
constexpr double kSetDown = 1e-3;         // [m] above the ground, to settle from

/// The wheel side of a part of the chassis, by sign.
int side_of(const btCompoundShape& chassis, int part, std::size_t wheels) {
  if (part <= kHullPart || part > static_cast<int>(2 * wheels)) return 0;
  return chassis.getChildTransform(part).getOrigin().y() > 0 ? 1 : -1;
}

}  // namespace

BulletVehicle::BulletVehicle(const RobotModel& robot, double period)
    : robot_(robot),
      substeps_(period, robot.arm ? robot.arm->step_rate : Substeps::kRate),
      physics_(robot.arm ? Physics::Bodies::Jointed : Physics::Bodies::Rigid) {}

BulletVehicle::~BulletVehicle() {
  take_down();
}

void BulletVehicle::take_down() {
  if (chassis_ == nullptr) return;
  arm_.reset();
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
  supports_.clear();
  const auto support = [&](double x, double y, double z, double radius) {
    add(make_bullet<btSphereShape>(radius), x, y, z);
    supports_.push_back({btVector3(x, y, z - p.mass_height), radius});
  };
  for (const double x : p.wheels) {
    for (const double y : {p.half_track, -p.half_track}) {
      support(x, y, p.wheel_radius, p.wheel_radius);
    }
  }
  for (const Caster& c : p.casters) support(c.x, c.y, c.radius + c.raised, c.radius);

  // The inertia of a solid box of the hull's size; the compound's own inertia is meaningless.
  const double xx = p.hull_length * p.hull_length;
  const double yy = p.hull_width * p.hull_width;
  const double zz = 4 * hull_half * hull_half;
  const double mass = p.mass + (p.arm ? p.arm->mass() : 0);
  const btVector3 inertia = btVector3(yy + zz, xx + zz, xx + yy) * (mass / 12);
  btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, chassis_shape_.get(), inertia);
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
  if (p.arm) arm_ = std::make_unique<BulletArm>(*p.arm, p.mass_height, physics_);
}

void BulletVehicle::reset(const algo::Pose2& start) {
  if (chassis_ != nullptr) {
    take_down();
    physics_.restart();
  }
  build_chassis();
  wanted_ = {};
  target_ = {};
  joint_rates_ = {};
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
  if (arm_) arm_->place(*chassis_);
  parked_ = true;
  still_for_ = 0;
}

/// Places the body with its z axis along `normal` and R at `height` [m]; at rest.
void BulletVehicle::set_on(const algo::Pose2& pose_W, const btVector3& normal, double height) {
  const btVector3 heading(std::cos(pose_W.heading), std::sin(pose_W.heading), 0);
  // The x axis keeps its heading on the map.
  const btVector3 left = normal.cross(heading).normalized();
  const btVector3 ahead = left.cross(normal);
  const btMatrix3x3 basis(ahead.x(),
                          left.x(),
                          normal.x(),
                          ahead.y(),
                          left.y(),
                          normal.y(),
                          ahead.z(),
                          left.z(),
                          normal.z());
  const btVector3 ground(pose_W.x, pose_W.y, height);
  const btTransform at(basis, ground + normal * robot_.mass_height);
  chassis_->setWorldTransform(at);
  chassis_->setInterpolationWorldTransform(at);
  chassis_->setLinearVelocity(btVector3(0, 0, 0));
  chassis_->setAngularVelocity(btVector3(0, 0, 0));
  physics_.set_down(*chassis_);
}

/// The plane through the ground under the wheels and casters, by least squares; then raised until
/// the ground is nowhere above it, so that the vehicle settles from above.
void BulletVehicle::stand_on(const ObstacleSet& ground) {
  level_ = !ground.has_ground();
  if (level_) return;
  const algo::Pose2 start = state_.pose_W;
  Eigen::Matrix3d sums = Eigen::Matrix3d::Identity() * 1e-9;  // a single line of supports has none
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  std::vector<algo::Vec3> under;  // x and y from R, along W's axes; height
  for (const Support& support : supports_) {
    const algo::Vec2 at_W = algo::to_parent(start, {support.centre.x(), support.centre.y()});
    under.emplace_back(at_W.x() - start.x, at_W.y() - start.y, ground.ground_at(at_W));
    const Eigen::Vector3d row(under.back().x(), under.back().y(), 1);
    sums += row * row.transpose();
    right += row * under.back().z();
  }
  const Eigen::Vector3d plane = sums.ldlt().solve(right);
  double height = plane.z();
  for (const algo::Vec3& p : under) {
    height = std::max(height, p.z() - plane.x() * p.x() - plane.y() * p.y());
  }
  set_on(start, btVector3(-plane.x(), -plane.y(), 1).normalized(), height + kSetDown);
  physics_.gather(ground, start.position(), robot_.radius + kNear);
  settle();
  read_state();
  // It may have slid a little while it settled.
  const algo::Vec2 slid = start.position() - state_.pose_W.position();
  const btVector3 n = chassis_->getWorldTransform().getBasis().getColumn(2);
  const double rise = -(n.x() * slid.x() + n.y() * slid.y()) / n.z();
  set_on(start, n, state_.z + rise);
  state_ = {};
  read_state();
  state_.pose_W = start;
  state_.twist = {};
  parked_ = false;  // it may slide or turn over by itself
  for (Support& support : supports_) {
    support.ground =
        ground.ground_at(algo::to_parent(start, {support.centre.x(), support.centre.y()}));
    support.edge.reset();
  }
}

/// A wheel or caster has fallen once it is lower than an edge that it passed, by more than the
/// robot can come down. Over a narrow trench it keeps its height, and the far edge ends the matter.
void BulletVehicle::watch_falls(const ObstacleSet& obstacles) {
  const double most = robot_.climbs ? robot_.climbs->step_down : kDropUnmeasured;
  for (Support& support : supports_) {
    const btVector3 centre = chassis_->getWorldTransform() * support.centre;
    const double ground = obstacles.ground_at({centre.x(), centre.y()});
    if (!support.edge && ground < support.ground - most) support.edge = support.ground;
    if (support.edge && ground >= *support.edge - most) support.edge.reset();
    if (support.edge && centre.z() - support.radius < *support.edge - most) state_.fallen = true;
    support.ground = ground;
  }
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
  if (wanted_ != algo::Twist2{} || joint_rates_ != algo::JointValues{}) {
    parked_ = false;
    still_for_ = 0;
  }
  level_ = !obstacles.has_ground();
  if (!parked_) state_.contact = false;
  if (!parked_) state_.scrape = false;
  if (!parked_) state_.ground_contact.reset();
  state_.arm.rate = {};
  if (!parked_) state_.arm.touched.reset();
  const algo::JointValues joints = state_.arm.position;
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
      if (!level_) watch_falls(obstacles);
      update_parking();
    }
    trail.push(state_.pose_W);
    if (!level_) trail.tilt(state_.tilt());
  }
  if (arm_) read_arm(joints);
}

void BulletVehicle::read_arm(const algo::JointValues& before) {
  const double tick = substeps_.length * static_cast<double>(substeps_.count);
  for (std::size_t k = 0; k < before.size(); ++k) {
    state_.arm.rate[k] = (state_.arm.position[k] - before[k]) / tick;
  }
}

bool BulletVehicle::arm_rests() const {
  return !arm_ || (joint_rates_ == algo::JointValues{} && arm_->settled());
}

/// One step of the physics under `target_`.
void BulletVehicle::substep() {
  const algo::SideMotion sides = algo::sides_of(target_, robot_.half_track);
  drive_->set({sides.left, sides.right, left_load_, right_load_, normal_});
  if (lean_ != 0) {
    const double heading = pose().heading;
    const btVector3 left(-std::sin(heading), std::cos(heading), 0);
    const btVector3 down(0, 0, -std::cos(lean_));
    chassis_->setGravity(Physics::kGravity * (down - std::sin(lean_) * left));
  }
  if (arm_) arm_->prepare(*chassis_, joint_rates_, substeps_.length);
  physics_.step(substeps_.length);
  read_contacts();
  if (!arm_) return;
  arm_->place(*chassis_);
  if (const auto link = arm_->touched()) state_.arm.touched = link;
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
    if (!first && manifold.getBody1() != chassis_.get()) continue;  // the arm's
    for (int c = 0; c < manifold.getNumContacts(); ++c) {
      const btManifoldPoint& point = manifold.getContactPoint(c);
      const int part = first ? point.m_index0 : point.m_index1;
      const btVector3 up = first ? point.m_normalWorldOnB : -point.m_normalWorldOnB;
      const double impulse = point.getAppliedImpulse();
      if (part == kHullPart) {
        const bool touching = impulse > 0 || point.getDistance() < kContactTouching;
        state_.scrape = state_.scrape || touching;
        if (touching && std::abs(up.z()) < 0.5) {
          state_.contact = true;
          if (Physics::is_ground(first ? *manifold.getBody1() : *manifold.getBody0())) {
            const btVector3 at = chassis_->getWorldTransform().invXform(
                first ? point.getPositionWorldOnA() : point.getPositionWorldOnB());
            state_.ground_contact = std::atan2(at.y(), at.x());
          }
        }
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
  const btVector3 ground = chassis_->getWorldTransform() * btVector3(0, 0, -robot_.mass_height);
  state_.z = ground.z();
  if (arm_) state_.arm.position = arm_->position();
}

/// Counts the time at rest, and parks after enough of it.
void BulletVehicle::update_parking() {
  const bool still = arm_rests() && wanted_ == algo::Twist2{} && target_ == algo::Twist2{} &&
                     std::abs(state_.twist.v) < kStillSpeed &&
                     std::abs(state_.twist.omega) < kStillTurn &&
                     (level_ || (chassis_->getLinearVelocity().length() < kSlowSlide &&
                                 chassis_->getAngularVelocity().length() < kSlowTilt));
  still_for_ = still ? still_for_ + substeps_.length : 0;
  if (still_for_ < kStillTime) return;
  parked_ = true;
  chassis_->setLinearVelocity(btVector3(0, 0, 0));
  chassis_->setAngularVelocity(btVector3(0, 0, 0));
  state_.twist = {};
}

}  // namespace sim
