#include "algo/arm/body_follower.hpp"

#include <algorithm>
#include <cmath>

#include "algo/diff_drive.hpp"

namespace algo {
namespace {

constexpr double kAtPoint = 1e-3;       // [m] a shorter way has no direction
constexpr double kShortest = 0.05;      // [s] of a motion of the joints: it ends without a jerk
constexpr double kStopsWithin = 0.003;  // [m] of its goal, along its way, the base stops
constexpr double kSameHeading = 0.02;   // [rad] a smaller turn takes the base no time
constexpr double kTurnFirst = 0.6;      // [rad] farther off its way the base turns on the spot
constexpr double kSettle = 0.5;         // [s] in which an error of heading or place is driven away
constexpr double kBrakes = 0.7;         // of its deceleration that a base plans to use
constexpr double kLook = 0.1;           // [s] between two looks at the next motion
constexpr double kSameRoom = 1e-6;      // [m]
constexpr double kForesees = 2;         // [s] ahead a base that stands sees something come
constexpr int kFarLooks = 10;           // in that time
constexpr double kSpeedMemory = 1;      // [s] of the speed that predicts when the body gets where
constexpr double kLeastSpeed = 0.1;     // [m/s] of the same: a body that waits will go on

/// Where the base's way leads.
struct BaseTarget {
  Vec2 carrot_W = Vec2::Zero();  // to steer for
  double left = 0;               // [m]
};

/// The carrot lies `lookahead` ahead on the strip. Beyond its end the way goes straight on, so that
/// the base does not circle about its goal.
BaseTarget base_target(const BodyStrip& strip, double lookahead) {
  const auto q = strip.configurations();
  const Vec2 goal = q.back().head<2>();
  const Vec2& onwards = strip.end_direction();
  double way = lookahead;
  for (std::size_t i = 0; i + 1 < q.size(); ++i) {
    const Vec2 step = (q[i + 1] - q[i]).head<2>();
    const double length = step.norm();
    if (way < length) return {q[i].head<2>() + step * way / length, strip.length()};
    way -= length;
  }
  return {goal + way * onwards, std::max(0.0, onwards.dot(goal - q.front().head<2>()))};
}

/// The base's part: towards the target, and onto `heading` once it is there.
Twist2 base_twist(const Pose2& pose,
                  const BaseTarget& target,
                  double heading,
                  const BodyLimits& limits) {
  const auto limited = [](double value, double most) { return std::clamp(value, -most, most); };
  const auto turning = [&](double error) { return limited(error / kSettle, limits.max_omega); };
  if (target.left < kStopsWithin) return {0, turning(wrap_angle(heading - pose.heading))};
  const Vec2 way = target.carrot_W - pose.position();
  const double error = wrap_angle(std::atan2(way.y(), way.x()) - pose.heading);
  if (std::abs(error) > kTurnFirst) return {0, turning(error)};
  const double brakes = std::sqrt(2 * kBrakes * limits.max_acceleration * target.left);
  const double v = std::min({limits.max_v, target.left / kSettle, brakes});
  return {v * std::cos(error), turning(error)};
}

/// Of the joints on the strip.
struct ArmAhead {
  ArmJoints q = ArmJoints::Zero();
  double time = 0;  // [s] until the joints are there, at the base's speed and theirs
};
/// `time` [s] ahead when the base drives at `v` [m/s]; the goal's if the strip ends before.
ArmAhead arm_ahead(std::span<const BodyJoints> strip,
                   double v,
                   const BodyLimits& limits,
                   double time) {
  double passed = 0;  // [s] with the joints as fast as the base's way asks,
  double slowed = 0;  // and as fast as they may
  for (std::size_t i = 0; i + 1 < strip.size(); ++i) {
    const BodyJoints change = strip[i + 1] - strip[i];
    const double way = change.head<2>().norm();
    const double turn = std::abs(wrap_angle(change[2]));
    const ArmJoints joints = arm_of(strip[i + 1]) - arm_of(strip[i]);
    const double shortest = joints.cwiseAbs().maxCoeff() / limits.max_rate;
    const bool stands = way < kAtPoint && turn < kSameHeading;
    const double planned =
        stands ? shortest : std::max(way / std::max(v, kLeastSpeed), turn / limits.max_omega);
    if (passed + planned > time) {
      const double part = (time - passed) / planned;
      return {arm_of(strip[i]) + part * joints, slowed + part * std::max(planned, shortest)};
    }
    passed += planned;
    slowed += std::max(planned, shortest);
  }
  return {arm_of(strip.back()), slowed};
}

}  // namespace

BodyFollower::BodyFollower(const MobileArm& body,
                           const BodyLimits& limits,
                           const BodyStripGains& gains,
                           const FollowRules& rules)
    : body_(body), limits_(limits), rules_(rules), strip_(body, gains) {}

void BodyFollower::begin(std::span<const BodyJoints> nominal) {
  strip_.lay(nominal);
}

BodyCommand BodyFollower::update(const BodyJoints& now, std::span<const Solid> solids, double dt) {
  strip_.follow(now, std::max(speed_, kLeastSpeed));
  strip_.relax(solids, rules_.sweeps);
  BodyCommand command = kept_clear(now, towards_strip(now), solids);
  speed_ += std::min(dt / kSpeedMemory, 1.0) * (command.base.v - speed_);
  return command;
}

BodyCommand BodyFollower::kept_clear(const BodyJoints& now,
                                     const BodyCommand& wanted,
                                     std::span<const Solid> solids,
                                     bool together) const {
  BodyCommand arm_alone = wanted;
  arm_alone.base = {};
  BodyCommand base_alone = wanted;
  base_alone.rates.setZero();
  const BodyCommand rest{.state = FollowState::Waits};
  if (together) arm_alone = base_alone = rest;
  const std::array candidates{wanted, arm_alone, base_alone, rest};
  const int looks = static_cast<int>(std::round(rules_.horizon / kLook));
  const Look near{.horizon = rules_.horizon, .looks = looks};
  const BodyCommand* best = nullptr;
  double best_room = 0;
  for (const BodyCommand& candidate : candidates) {
    const double room = least_room(now, candidate, solids, near);
    if (room >= 0) return candidate;
    if (best != nullptr && room <= best_room + kSameRoom) continue;
    best = &candidate;
    best_room = room;
  }
  if (!rules_.gives_way) return *best;
  const BodyCommand aside = out_of_the_way(now, solids);
  return aside.base.v != 0 ? aside : *best;
}

BodyCommand BodyFollower::out_of_the_way(const BodyJoints& now,
                                         std::span<const Solid> solids) const {
  const Look moving{.of = Look::Of::Moving, .horizon = kForesees, .looks = kFarLooks};
  const Look present{.of = Look::Of::Present, .horizon = kForesees, .looks = kFarLooks};
  BodyCommand best{.state = FollowState::Waits};
  if (least_room(now, best, solids, moving) >= 0) return best;
  double most = least_room(now, best, solids, present);
  for (const double v : {limits_.max_v, -limits_.max_v}) {
    const BodyCommand aside{.base = {v, 0}, .state = FollowState::Waits};
    const double room = least_room(now, aside, solids, present);
    if (room <= most + kSameRoom) continue;
    best = aside;
    most = room;
  }
  return best;
}

BodyCommand BodyFollower::towards_strip(const BodyJoints& now) const {
  const auto configurations = strip_.configurations();
  const BodyJoints& goal = strip_.goal();
  const ArmJoints to_goal = arm_of(goal) - arm_of(now);
  const double turn = wrap_angle(goal[2] - now[2]);
  const BaseTarget target = base_target(strip_, rules_.lookahead);
  BodyCommand command;
  if (target.left < kStopsWithin && strip_.length() < rules_.base_reach &&
      std::abs(turn) < rules_.goal_reach && to_goal.cwiseAbs().maxCoeff() < rules_.goal_reach) {
    command.state = FollowState::Arrived;
  }
  command.base = base_twist(base_of(now), target, goal[2], limits_);

  if (strip_.stands()) {
    // The arm works among things: from one configuration of its planned way straight to the next.
    const ArmJoints change = arm_of(configurations[1]) - arm_of(now);
    command.rates_last = std::max(change.cwiseAbs().maxCoeff() / limits_.max_rate, kShortest);
    command.rates = change / command.rates_last;
    return command;
  }
  // The joints make for the strip's configuration at the end of the horizon, so that the motion
  // which is proved clear ends there. Where they cannot keep up, the base slows down.
  const ArmAhead ahead = arm_ahead(configurations, command.base.v, limits_, rules_.horizon);
  const ArmJoints change = ahead.q - arm_of(now);
  const double time = std::max(change.cwiseAbs().maxCoeff() / limits_.max_rate, rules_.horizon);
  command.rates = change / time;
  const double slower = std::min(1.0, rules_.horizon / std::max(time, ahead.time));
  command.base.v *= slower;
  command.base.omega *= slower;
  return command;
}

double BodyFollower::least_room(const BodyJoints& now,
                                const BodyCommand& command,
                                std::span<const Solid> solids,
                                const Look& look) const {
  const auto counts = [&](const Solid& solid) {
    if (look.of == Look::Of::Moving) return !solid.velocity_W.isZero();
    return look.of == Look::Of::All || !solid.foreseen;
  };
  double least = std::numeric_limits<double>::infinity();
  for (int n = 1; n <= look.looks; ++n) {
    const double time = look.horizon * n / look.looks;
    const BodyFrames frames = body_frames(body_, moved(now, command, time));
    if (look.of != Look::Of::Moving) {
      least = std::min(least, self_clearance(body_, frames) - rules_.own_margin);
    }
    for (std::size_t k = 0; k < kBodyLinks; ++k) {
      const LinkAxis link = link_axis(body_, frames, static_cast<BodyLink>(k));
      for (const Solid& solid : solids) {
        if (!counts(solid)) continue;
        least = std::min(least, nearest(link, solid.after(time)).distance - rules_.margin);
      }
    }
  }
  return least;
}

BodyJoints moved(const BodyJoints& body, const BodyCommand& command, double dt) {
  return body_joints(integrate_arc(base_of(body), command.base, dt),
                     arm_of(body) + std::min(dt, command.rates_last) * command.rates);
}

}  // namespace algo
