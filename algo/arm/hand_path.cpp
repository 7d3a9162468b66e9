// algo/arm/hand_path.cpp: the damped inverse of the hand's Jacobian, and forces in its null space.
#include "algo/arm/hand_path.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace algo {
namespace {

constexpr double kDamping = 0.02;       // [m] keeps the rates finite where the arm is stretched
constexpr double kNullShare = 0.6;      // of the limits: what is left is the hand's
constexpr double kHandAtEnd = 0.003;    // [m]
constexpr double kTurnedAtEnd = 0.005;  // [rad]
constexpr double kDrives = 0.01;        // [m/s] the base drives forwards or backwards
constexpr double kNearLimit = 0.9;      // of a joint's limit, from where on it is held back
constexpr double kHeldBack = 2;         // [1/s]
constexpr double kShortPiece = 1e-9;    // [m]

/// [rad] The turn from `now` to `wanted`, as a vector in W.
Vec3 turn_between(const Eigen::Matrix3d& now, const Eigen::Matrix3d& wanted) {
  const Eigen::AngleAxisd turn(wanted * now.transpose());
  return turn.angle() * turn.axis();
}

}  // namespace

HandPath::HandPath(const MobileArm& body, const BodyLimits& limits, const HandPathRules& rules)
    : body_(body), limits_(limits), rules_(rules) {}

void HandPath::begin(const BodyJoints& now,
                     const Eigen::Matrix3d& hand_W,
                     std::span<const Vec3> points_W,
                     bool base_stays) {
  points_W_.assign(points_W.begin(), points_W.end());
  next_ = 0;
  place_W_ = body_frames(body_, now).hand();
  attitude_W_ = hand_W;
  posture_ = arm_of(now);
  base_stays_ = base_stays;
  forward_ = 1;
  off_ = 0;
}

Vec3 HandPath::lead(const Vec3& hand_W, double dt) {
  off_ = (place_W_ - hand_W).norm();
  if (off_ > rules_.lag) return Vec3::Zero();
  const Vec3 before = place_W_;
  double left = rules_.speed * dt;
  while (next_ < points_W_.size()) {
    const Vec3 way = points_W_[next_] - place_W_;
    const double length = way.norm();
    if (length > left && length > kShortPiece) {
      place_W_ += left / length * way;
      break;
    }
    place_W_ = points_W_[next_++];
    left -= length;
  }
  return (place_W_ - before) / dt;
}

HandPath::HandJacobian HandPath::jacobian(const BodyFrames& frames) const {
  HandJacobian j = HandJacobian::Zero();
  if (!base_stays_) {
    j.col(0).head<3>() = frames.base_W.linear().col(0);
    j.col(1).head<3>() = Vec3::UnitZ().cross(frames.hand() - frames.base_W.translation());
    j(5, 1) = 1;
  }
  j.rightCols<static_cast<int>(kArmJoints)>() = arm_jacobian(frames.arm_W);
  return j;
}

/// [rad/s] The base turns aside where `solid` is in its way or beside it: out of the solid's shadow
/// along the way (see solid_shadow()).
double HandPath::turning_aside(const BodyFrames& frames, const Solid& solid) const {
  const LinkAxis base = link_axis(body_, frames, BodyLink::Base);
  const Vec2 ahead_W = frames.base_W.linear().col(0).head<2>();
  const double gap = gap_along(base.from_W, base.to_W, solid, ahead_W) - base.radius;
  const double near = 1 - std::max(gap, 0.0) / rules_.sight;
  const Solid shadow = solid_shadow(solid, ahead_W, base.from_W.head<2>());
  const NearestOnLink there = nearest(base, shadow);
  const double inside = rules_.reach - there.distance;
  if (near <= 0 || inside <= 0) return 0;
  const double side = cross(ahead_W, there.away.head<2>());
  return forward_ * rules_.aside * near * inside * side;
}

/// Away from things, from the robot itself and from the joints' limits, and back to the posture.
HandPath::BodyRates HandPath::yielding(const BodyJoints& now,
                                       const BodyFrames& frames,
                                       std::span<const Solid> solids) const {
  BodyJoints force = BodyJoints::Zero();
  double turn = 0;
  for (const Solid& solid : solids) {
    turn += turning_aside(frames, solid);
    for (std::size_t k = 0; k < kBodyLinks; ++k) {
      const LinkAxis link = link_axis(body_, frames, static_cast<BodyLink>(k));
      const NearestOnLink there = nearest(link, solid);
      const double inside = rules_.reach - there.distance;
      if (inside <= 0) continue;
      add_force(frames, link.joints, there.point_W, rules_.push * inside * there.away, force);
    }
  }
  BodyRates rates;
  rates << frames.base_W.linear().col(0).head<2>().dot(force.head<2>()), force[2] + turn,
      arm_of(force);
  auto joints = rates.tail<static_cast<int>(kArmJoints)>();
  for (const OwnContact& contact : own_contacts(body_, frames)) {
    const double inside = rules_.own_reach - contact.nearest.distance;
    if (inside <= 0) continue;
    BodyJoints own = BodyJoints::Zero();
    const Vec3 push = rules_.push * inside * contact.nearest.away;
    add_force(frames, contact.link.joints, contact.nearest.point_W, push, own);
    joints += arm_of(own);
  }
  const ArmJoints q = arm_of(now);
  const ArmJoints most = kNearLimit * body_.arm.limits;
  joints += rules_.posture * (posture_ - q) + kHeldBack * (q.cwiseMax(-most).cwiseMin(most) - q);
  return rates;
}

/// In the same direction, no faster than the limits allow.
HandPath::BodyRates HandPath::limited(BodyRates rates) const {
  const double fastest = rates.tail<static_cast<int>(kArmJoints)>().cwiseAbs().maxCoeff();
  const double over = std::max({std::abs(rates[0]) / limits_.max_v,
                                std::abs(rates[1]) / limits_.max_omega,
                                fastest / limits_.max_rate,
                                1.0});
  return rates / over;
}

BodyCommand HandPath::update(const BodyJoints& now, std::span<const Solid> solids, double dt) {
  const BodyFrames frames = body_frames(body_, now);
  const Vec3 moving = lead(frames.hand(), dt);
  const Vec3 turn = turn_between(frames.arm_W.hand().linear(), attitude_W_);
  Eigen::Matrix<double, 6, 1> wanted;
  wanted << moving + rules_.correction * (place_W_ - frames.hand()), rules_.correction * turn;

  const HandJacobian j = jacobian(frames);
  const Eigen::Matrix<double, 6, 6> gram =
      j * j.transpose() + kDamping * kDamping * Eigen::Matrix<double, 6, 6>::Identity();
  const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> inverse(gram);
  BodyRates aside = yielding(now, frames, solids);
  if (base_stays_) aside.head<2>().setZero();
  aside = kNullShare * limited(aside / kNullShare);
  const BodyRates rates = limited(aside + j.transpose() * inverse.solve(wanted - j * aside));

  BodyCommand command;
  command.base = {rates[0], rates[1]};
  command.rates = rates.tail<static_cast<int>(kArmJoints)>();
  if (std::abs(rates[0]) > kDrives) forward_ = rates[0] < 0 ? -1 : 1;
  const bool at_end = next_ == points_W_.size() && off_ < kHandAtEnd && turn.norm() < kTurnedAtEnd;
  if (at_end) return {.state = FollowState::Arrived};
  if (moving.isZero() && next_ < points_W_.size()) command.state = FollowState::Waits;
  return command;
}

}  // namespace algo
