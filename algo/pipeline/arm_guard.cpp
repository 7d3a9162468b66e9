// algo/pipeline/arm_guard.cpp: the motion in short looks.
#include "algo/pipeline/arm_guard.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace algo {
namespace {

constexpr double kArmLook = 0.05;     // [s] between two looks at the motion
constexpr double kArmActs = 2;        // periods until another command can take its place
constexpr double kJointStops = 0.05;  // [s] in which a joint takes on another rate
constexpr double kEqualRoom = 1e-6;   // [m]
constexpr int kMostLooks = 100;

double arm_length(const MobileArm& body) {
  return body.arm.upper_arm + body.arm.lower_arm() + body.arm.hand + body.link_radius;
}

ArmJoints rates_of(const Command& command) {
  return Eigen::Map<const ArmJoints>(command.joint_rates.data());
}

}  // namespace

ArmGuard::ArmGuard(const RobotSpec& spec)
    : body_(mobile_arm(*spec.arm, spec.radius)), limits_(limits_of(spec)), period_(spec.period) {
  const double stops = limits_.max_v * (kArmActs * period_ + kArmLook) +
                       limits_.max_v * limits_.max_v / (2 * limits_.acceleration);
  reach_ = std::max(spec.radius, spec.arm->shoulder_R.head<2>().norm() + arm_length(body_)) +
           stops + kMargin;
}

double ArmGuard::room(const BodyJoints& q, std::span<const Solid> near, double time) const {
  const BodyFrames frames = body_frames(body_, q);
  double least = self_clearance(body_, frames) - kOwnMargin;
  for (std::size_t k = 0; k < kBodyLinks; ++k) {
    const auto part = static_cast<BodyLink>(k);
    const double margin = part == BodyLink::Base ? kBaseMargin : kMargin;
    const LinkAxis link = link_axis(body_, frames, part);
    for (const Solid& solid : near) {
      least = std::min(least, nearest(link, solid.after(time)).distance - margin);
    }
  }
  return least;
}

/// [m] No point of the body moves farther until it stands.
double ArmGuard::farthest(const Motion& motion,
                          std::span<const Solid> near,
                          const Command& command) const {
  const double acts = kArmActs * period_ + kArmLook;
  const double v = std::max(std::abs(motion.base.v), std::abs(command.base.v));
  const double w = std::max(std::abs(motion.base.omega), std::abs(command.base.omega));
  const double way = v * acts + v * v / (2 * limits_.acceleration);
  const double turn = w * acts + w * w / (2 * limits_.angular_acceleration);
  const double joints = rates_of(command).cwiseAbs().sum() * (acts + kJointStops) +
                        motion.rates.cwiseAbs().sum() * kJointStops;
  double fastest = 0;  // [m/s] of a thing
  for (const Solid& solid : near) fastest = std::max(fastest, solid.velocity_W.norm());
  const double stands = acts + std::max(v / limits_.acceleration, w / limits_.angular_acceleration);
  return way + turn * reach_ + joints * arm_length(body_) + fastest * stands;
}

double ArmGuard::least_room(const BodyJoints& now,
                            const Motion& motion,
                            std::span<const Solid> near,
                            const Command& command) const {
  const ArmJoints rates = rates_of(command);
  MotionState state{base_of(now), motion.base};
  ArmJoints q =
      arm_of(now) + kJointStops / 2 * (motion.rates - rates);  // they do not change at once
  double least = std::numeric_limits<double>::infinity();
  const double acts = kArmActs * period_;
  const auto look = [&](double time) {
    least = std::min(least, room(body_joints(state.pose_W, q), near, time));
  };
  double time = 0;
  const auto go = [&](double length, const Twist2& wanted, double turning) {
    state = advanced(state, wanted, limits_, length);
    q += turning * rates;
    for (Eigen::Index k = 0; k < q.size(); ++k) {
      q[k] = std::clamp(q[k], -body_.arm.limits[k], body_.arm.limits[k]);
    }
    time += length;
    look(time);
  };
  const double pieces = std::ceil(acts / kArmLook);
  for (int k = 0; k < pieces; ++k) go(acts / pieces, command.base, acts / pieces);
  go(kJointStops, {}, kJointStops);
  for (int k = 0; k < kMostLooks && state.twist != Twist2{}; ++k) go(kArmLook, {}, 0);
  return least;
}

Command ArmGuard::limited(const BodyJoints& now,
                          const Motion& motion,
                          std::span<const Solid> near,
                          const Command& command) const {
  const bool moves = command.base != Twist2{} || !rates_of(command).isZero();
  if (!moves) return command;
  if (room(now, near, 0) > farthest(motion, near, command)) return command;
  Command arm_alone = command;
  arm_alone.base = {};
  Command base_alone = command;
  base_alone.joint_rates = {};
  Command rest = arm_alone;
  rest.joint_rates = {};
  const std::array candidates{command, arm_alone, base_alone, rest};
  const Command* best = nullptr;
  double most = 0;
  for (const Command& candidate : candidates) {
    const double left = least_room(now, motion, near, candidate);
    if (left >= 0) return candidate;
    if (best != nullptr && left <= most + kEqualRoom) continue;
    best = &candidate;
    most = left;
  }
  return *best;
}

}  // namespace algo
