// algo/arm/hand_path.cpp: the damped inverse of the hand's Jacobian, and all else in its null
// space.
#include "algo/arm/hand_path.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace algo {
namespace {

constexpr double kDamping = 0.02;       // [m] keeps the rates finite where the arm is stretched
constexpr double kNullShare = 0.8;      // of the limits: what is left is the hand's
constexpr double kHandAtEnd = 0.003;    // [m]
constexpr double kTurnedAtEnd = 0.005;  // [rad]
constexpr double kNearLimit = 0.97;     // of a joint's limit, from where on it is held back
constexpr double kHeldBack = 2;         // [1/s]

/// [rad] The turn from `now` to `wanted`, as a vector in W.
Vec3 turn_between(const Eigen::Matrix3d& now, const Eigen::Matrix3d& wanted) {
  const Eigen::AngleAxisd turn(wanted * now.transpose());
  return turn.angle() * turn.axis();
}

/// From `a` to `b`, the short way round.
BodyJoints change_between(const BodyJoints& a, const BodyJoints& b) {
  BodyJoints change = b - a;
  change[2] = wrap_angle(change[2]);
  return change;
}

}  // namespace

HandPath::HandPath(const MobileArm& body, const BodyLimits& limits, const HandPathRules& rules)
    : body_(body), limits_(limits), rules_(rules) {}

void HandPath::reset() {
  plan_.clear();
  done_ = 0;
}

void HandPath::begin(std::span<const BodyJoints> plan) {
  plan_.assign(plan.begin(), plan.end());
  hands_W_.clear();
  ways_.clear();
  for (const BodyJoints& q : plan_) {
    const Vec3 hand_W = body_frames(body_, q).hand();
    ways_.push_back(ways_.empty() ? 0 : ways_.back() + (hand_W - hands_W_.back()).norm());
    hands_W_.push_back(hand_W);
  }
  attitude_W_ = body_frames(body_, plan_.front()).arm_W.hand().linear();
  base_stays_ = std::ranges::all_of(
      plan_, [&](const BodyJoints& q) { return q.head<3>() == plan_.front().head<3>(); });
  done_ = 0;
}

HandPath::Lead HandPath::lead(const Vec3& hand_W, double dt) {
  const auto at = [this] {
    const auto next = std::ranges::upper_bound(ways_, done_) - ways_.begin();
    return std::min(static_cast<std::size_t>(next), ways_.size() - 1);
  };
  const auto place = [this](std::size_t next, Lead& out) {
    const std::size_t last = next - 1;
    const double length = ways_[next] - ways_[last];
    const double part = length > 0 ? (done_ - ways_[last]) / length : 1;
    const BodyJoints change = change_between(plan_[last], plan_[next]);
    out.q = plan_[last] + part * change;
    out.hand_W = hands_W_[last] + part * (hands_W_[next] - hands_W_[last]);
    if (length > 0) out.rates = change / length;
  };
  Lead out{.q = plan_.back(), .hand_W = hands_W_.back()};
  if (ways_.size() < 2) return out;
  place(at(), out);
  const Vec3 before = out.hand_W;
  const bool goes = done_ < ways_.back() && (before - hand_W).norm() <= rules_.lag;
  if (!goes) {
    out.rates.setZero();
    return out;
  }
  const double from = done_;
  done_ = std::min(ways_.back(), done_ + rules_.speed * dt);
  place(at(), out);
  out.rates *= (done_ - from) / dt;
  out.speed_W = (out.hand_W - before) / dt;
  return out;
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

HandPath::BodyRates HandPath::planned(const BodyJoints& now, const Lead& lead) const {
  const Pose2 here = base_of(now);
  const Vec2 ahead_W = direction(here.heading);
  const BodyJoints left = change_between(now, lead.q);
  const double v = ahead_W.dot(lead.rates.head<2>());
  const double across = cross(ahead_W, left.head<2>());
  BodyRates rates;
  rates[0] = v + rules_.back * ahead_W.dot(left.head<2>());
  rates[1] = lead.rates[2] + rules_.back * left[2] + rules_.steer * v * across;
  rates.tail<static_cast<int>(kArmJoints)>() = arm_of(lead.rates) + rules_.back * arm_of(left);
  return rates;
}

HandPath::BodyRates HandPath::yielding(const BodyJoints& now,
                                       const BodyFrames& frames,
                                       std::span<const Solid> solids) const {
  BodyJoints force = BodyJoints::Zero();
  for (const Solid& solid : solids) {
    const bool stands = solid.velocity_W.isZero() && !solid.foreseen;
    const double reach = stands ? rules_.standing_reach : rules_.reach;
    for (std::size_t k = 0; k < kBodyLinks; ++k) {
      const LinkAxis link = link_axis(body_, frames, static_cast<BodyLink>(k));
      const NearestOnLink there = nearest(link, solid);
      const double inside = reach - there.distance;
      if (inside <= 0) continue;
      add_force(frames, link.joints, there.point_W, rules_.push * inside * there.away, force);
    }
  }
  for (const OwnContact& contact : own_contacts(body_, frames)) {
    const double inside = rules_.own_reach - contact.nearest.distance;
    if (inside <= 0) continue;
    BodyJoints own = BodyJoints::Zero();
    const Vec3 push = rules_.push * inside * contact.nearest.away;
    add_force(frames, contact.link.joints, contact.nearest.point_W, push, own);
    force.tail<static_cast<int>(kArmJoints)>() += arm_of(own);
  }
  const ArmJoints q = arm_of(now);
  const ArmJoints most = kNearLimit * body_.arm.limits;
  BodyRates rates;
  rates << frames.base_W.linear().col(0).head<2>().dot(force.head<2>()), force[2],
      arm_of(force) + kHeldBack * (q.cwiseMax(-most).cwiseMin(most) - q);
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
  if (plan_.empty()) return {.state = FollowState::Arrived};
  const BodyFrames frames = body_frames(body_, now);
  const Lead wanted = lead(frames.hand(), dt);
  const Vec3 off = wanted.hand_W - frames.hand();
  const Vec3 turn = turn_between(frames.arm_W.hand().linear(), attitude_W_);
  const bool at_end = done_ >= ways_.back();
  if (at_end && off.norm() < kHandAtEnd && turn.norm() < kTurnedAtEnd) {
    return {.state = FollowState::Arrived};
  }
  Eigen::Matrix<double, 6, 1> hand;
  hand << wanted.speed_W + rules_.correction * off, rules_.correction * turn;
  const HandJacobian j = jacobian(frames);
  const Eigen::Matrix<double, 6, 6> gram =
      j * j.transpose() + kDamping * kDamping * Eigen::Matrix<double, 6, 6>::Identity();
  const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> inverse(gram);
  BodyRates aside = planned(now, wanted) + yielding(now, frames, solids);
  if (base_stays_) aside.head<2>().setZero();
  aside = kNullShare * limited(aside / kNullShare);
  const BodyRates rates = limited(aside + j.transpose() * inverse.solve(hand - j * aside));

  BodyCommand command;
  command.base = {rates[0], rates[1]};
  command.rates = rates.tail<static_cast<int>(kArmJoints)>();
  if (wanted.speed_W.isZero() && !at_end) command.state = FollowState::Waits;
  return command;
}

}  // namespace algo
