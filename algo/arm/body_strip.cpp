#include "algo/arm/body_strip.hpp"

#include <algorithm>
#include <stdexcept>

namespace algo {
namespace {

constexpr double kAtRest = 1e-5;     // [m, rad] a smaller change of every entry ends the sweeps
constexpr double kOwnStiffness = 4;  // beside the force of solids: its reach is short
constexpr double kNoLength = 1e-12;  // [m]
constexpr double kOffPlace = 0.03;   // [m] a start off its place by less is no way to drive
constexpr double kStands = 1e-3;     // [m] the base stands between configurations nearer than this
constexpr double kReached = 0.02;    // [rad] of each joint

/// Joints that move base, shoulder, elbow, wrist and hand.
constexpr std::array<std::size_t, 5> kJointsOfPoint{0, 0, 2, 4, 6};

}  // namespace

BodyStripGains printed_gains() {
  BodyStripGains gains;
  gains.external_force = ExternalForce::AtJoints;
  gains.internal = 0.8;
  gains.external = 0.6;
  gains.base_weight = 0.15;
  gains.own_reach = 0;
  gains.smoothing = 0;
  return gains;
}

BodyStrip::BodyStrip(const MobileArm& body, const BodyStripGains& gains)
    : body_(body), gains_(gains) {}

void BodyStrip::lay(std::span<const BodyJoints> nominal) {
  if (nominal.size() < 2) throw std::invalid_argument("A strip needs a start and a goal.");
  nominal_.assign(nominal.begin(), nominal.end());
  now_ = nominal_;
  frames_.resize(now_.size());
  points_.resize(now_.size());
  ahead_.assign(now_.size(), 0.0);
  end_direction_.setZero();
  for (std::size_t i = now_.size() - 1; i > 0 && end_direction_.isZero(); --i) {
    const Vec2 way = (now_[i] - now_[i - 1]).head<2>();
    if (way.norm() > kOffPlace) end_direction_ = way.normalized();
  }
  for (std::size_t i = 0; i < now_.size(); ++i) place(i);
}

void BodyStrip::follow(const BodyJoints& now, double speed) {
  now_.front() = now;
  place(0);
  while (now_.size() > 2 && passed_next()) {
    now_.erase(now_.begin() + 1);
    nominal_.erase(nominal_.begin() + 1);
    frames_.erase(frames_.begin() + 1);
    points_.erase(points_.begin() + 1);
    ahead_.erase(ahead_.begin() + 1);
  }
  for (std::size_t i = 1; i < now_.size(); ++i) {
    const double way = (points_[i][0] - points_[i - 1][0]).norm();
    ahead_[i] = ahead_[i - 1] + (speed > 0 ? way / speed : 0.0);
  }
}

double BodyStrip::length() const {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
    sum += (points_[i + 1][0] - points_[i][0]).norm();
  }
  return sum;
}

bool BodyStrip::passed_next() const {
  const Vec3 onwards = points_[2][0] - points_[1][0];
  // Where only the arm moves on, it goes from one configuration to the next: its way may turn back,
  // and then it has no side on which a configuration is passed.
  if (onwards.norm() < kStands) {
    return (arm_of(now_[1]) - arm_of(now_[0])).cwiseAbs().maxCoeff() < kReached;
  }
  return (points_[0][0] - points_[1][0]).dot(onwards) >= 0;
}

int BodyStrip::relax(std::span<const Solid> solids, int sweeps) {
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    double largest = 0;
    for (std::size_t i = 1; i + 1 < now_.size(); ++i) {
      BodyJoints force = BodyJoints::Zero();
      if (!stands()) add_internal(i, force);
      add_external(i, solids, force);
      push_off_itself(i, force);
      largest = std::max(largest, move(i, force));
    }
    largest = std::max(largest, yield_at_goal(solids));
    if (largest < kAtRest) return sweep + 1;
  }
  return sweeps;
}

void BodyStrip::place(std::size_t i) {
  const BodyFrames& frames = frames_[i] = body_frames(body_, now_[i]);
  points_[i] = {frames.base_W.translation(),
                frames.shoulder(),
                frames.elbow(),
                frames.wrist(),
                frames.hand()};
}

void BodyStrip::add_internal(std::size_t i, BodyJoints& force) const {
  for (std::size_t k = 0; k < kPoints; ++k) {
    const Vec3 before = points_[i][k] - points_[i - 1][k];
    const Vec3 after = points_[i + 1][k] - points_[i][k];
    const double part = before.norm();
    const double whole = part + after.norm();
    if (whole < kNoLength) continue;
    const Vec3 pull = part / whole * (before + after) - before;
    add_force(frames_[i], kJointsOfPoint[k], points_[i][k], gains_.internal * pull, force);
  }
}

void BodyStrip::add_external(std::size_t i,
                             std::span<const Solid> solids,
                             BodyJoints& force) const {
  const Vec3 path = points_[i + 1][0] - points_[i - 1][0];
  const double length = path.norm();
  const bool drives = !stands() && length > kNoLength;
  const Vec3 ahead = drives ? Vec3(path / length) : Vec3(Vec3::Zero());
  for (const Solid& solid_now : solids) {
    const Solid solid = solid_now.after(ahead_[i]);
    switch (gains_.external_force) {
      case ExternalForce::AtJoints:
        push_joints(i, solid, force);
        break;
      case ExternalForce::AcrossThePath:
        push_nearest(i, ahead, solid, force);
        break;
      case ExternalForce::Shadow:
        if (drives) {
          push_out_of_shadow(i, ahead, solid, force);
        } else {
          push_nearest(i, ahead, solid, force);
        }
    }
  }
}

void BodyStrip::push_off_itself(std::size_t i, BodyJoints& force) const {
  if (gains_.own_reach <= 0) return;
  BodyJoints own = BodyJoints::Zero();
  for (const OwnContact& contact : own_contacts(body_, frames_[i])) {
    const double inside = gains_.own_reach - contact.nearest.distance;
    if (inside <= 0) continue;
    add_force(frames_[i],
              contact.link.joints,
              contact.nearest.point_W,
              kOwnStiffness * gains_.external * inside * contact.nearest.away,
              own);
  }
  own.head<3>().setZero();  // an inner force: the base feels its reaction as well
  force += own;
}

void BodyStrip::push_joints(std::size_t i, const Solid& solid, BodyJoints& force) const {
  for (std::size_t k = 0; k < kPoints; ++k) {
    const SolidDistance there = distance_to(solid, points_[i][k]);
    const double inside = gains_.reach - there.distance;
    if (inside <= 0) continue;
    add_force(
        frames_[i], kJointsOfPoint[k], points_[i][k], gains_.external * inside * there.away, force);
  }
}

void BodyStrip::push_nearest(std::size_t i,
                             const Vec3& ahead,
                             const Solid& solid,
                             BodyJoints& force) const {
  // The plan of the arm's way knew the solids that stand. It did not know the paths of those that
  // move.
  const bool planned_for = ahead.isZero() && solid.velocity_W.isZero();
  const double reach = planned_for ? gains_.standing_reach : gains_.reach;
  for (std::size_t k = 0; k < kBodyLinks; ++k) {
    const LinkAxis link = link_axis(body_, frames_[i], static_cast<BodyLink>(k));
    const NearestOnLink there = nearest(link, solid);
    const double inside = reach - there.distance;
    if (inside <= 0) continue;
    const Vec3 across = there.away - there.away.dot(ahead) * ahead;
    add_force(frames_[i], link.joints, there.point_W, gains_.external * inside * across, force);
  }
}

void BodyStrip::push_out_of_shadow(std::size_t i,
                                   const Vec3& ahead,
                                   const Solid& solid,
                                   BodyJoints& force) const {
  const Solid shadow = solid_shadow(solid, ahead.head<2>(), points_[i][1].head<2>());
  for (std::size_t k = 0; k < kBodyLinks; ++k) {
    const LinkAxis link = link_axis(body_, frames_[i], static_cast<BodyLink>(k));
    const double gap = gap_along(link.from_W, link.to_W, solid, ahead.head<2>()) - link.radius;
    const double near = 1 - std::max(gap, 0.0) / gains_.reach;
    if (near <= 0) continue;
    const NearestOnLink there = nearest(link, shadow);
    const double inside = gains_.reach - there.distance;
    if (inside <= 0) continue;
    add_force(frames_[i],
              link.joints,
              there.point_W,
              gains_.external * near * inside * there.away,
              force);
  }
}

double BodyStrip::yield_at_goal(std::span<const Solid> solids) {
  const std::size_t goal = now_.size() - 1;
  BodyJoints force = BodyJoints::Zero();
  for (const Solid& solid : solids) {
    if (!solid.velocity_W.isZero())
      push_nearest(goal, Vec3::Zero(), solid.after(ahead_[goal]), force);
  }
  if (!force.isZero()) push_off_itself(goal, force);
  force.head<3>().setZero();  // the base's place is the goal's
  return move(goal, force);
}

double BodyStrip::move(std::size_t i, const BodyJoints& force) {
  BodyJoints change = force;
  BodyJoints back = nominal_[i] - now_[i];
  change.head<3>() = gains_.base_weight * change.head<3>() + gains_.base_spring * back.head<3>();
  if (stands()) change.head<3>().setZero();
  constexpr auto kArm = static_cast<int>(kArmJoints);
  change.tail<kArm>() +=
      (stands() ? gains_.standing_spring : gains_.joint_spring) * back.tail<kArm>();
  if (i + 1 < now_.size() && !stands()) {
    const BodyJoints between = (now_[i - 1] + now_[i + 1]) / 2;
    change.tail<kArm>() += gains_.smoothing * (between - now_[i]).tail<kArm>();
  }
  change = (gains_.step * change).cwiseMax(-gains_.longest).cwiseMin(gains_.longest);
  const BodyJoints before = now_[i];
  now_[i] += change;
  now_[i].tail<static_cast<int>(kArmJoints)>() = now_[i]
                                                     .tail<static_cast<int>(kArmJoints)>()
                                                     .cwiseMax(-body_.arm.limits)
                                                     .cwiseMin(body_.arm.limits);
  place(i);
  return (now_[i] - before).cwiseAbs().maxCoeff();
}

}  // namespace algo
