#include "algo/arm/reach_task.hpp"

#include <cmath>
#include <utility>

namespace algo {
namespace {

constexpr int kMostPlans = 5;  // for one goal
constexpr std::size_t kTriedPlaces =
    3;                                 // of the base; a plan after one that failed leaves them out
constexpr double kPlay = 0.01;         // [m] by which the body may come nearer than planned
constexpr double kPatience = 4;        // [s] without a motion before it plans anew
constexpr double kStandsStill = 1e-3;  // [m/s, rad/s]

/// True if `command` carries on a leg. An arm that gives way while the base stands does not.
bool carries_on(const BodyCommand& command, ReachLeg::Kind kind) {
  if (kind == ReachLeg::Kind::Arm) return command.rates.cwiseAbs().maxCoeff() > kStandsStill;
  return std::abs(command.base.v) > kStandsStill || std::abs(command.base.omega) > kStandsStill;
}

}  // namespace

ReachTask::ReachTask(const MobileArm& body, const BodyLimits& limits, const ReachRules& rules)
    : body_(body),
      rules_(rules),
      follower_(body, limits, {}, {.margin = rules.arm.margin - kPlay}) {}

void ReachTask::begin(const BodyJoints& now,
                      const Pose3& hand_W,
                      std::span<const Solid> solids,
                      std::uint64_t seed) {
  hand_W_ = hand_W;
  seed_ = seed;
  plans_ = 0;
  still_ = 0;
  if (!plan_anew(now, solids)) give_up();
}

BodyCommand ReachTask::update(const BodyJoints& now, std::span<const Solid> solids, double dt) {
  if (state_ == State::GivenUp || legs_.empty()) return {.state = FollowState::Waits};
  BodyCommand command = follower_.update(now, solids, dt);
  if (command.state == FollowState::Arrived && leg_ + 1 < legs_.size()) {
    next_leg(now, solids);
    return {};
  }
  if (command.state == FollowState::Arrived) {
    state_ = State::Arrived;
    still_ = 0;
    return command;
  }
  still_ = carries_on(command, legs_[leg_].kind) ? 0 : still_ + dt;
  state_ = still_ > 0 ? State::Waits : State::Goes;
  if (still_ > kPatience) {
    // Where there is no other way, the planned one may become free.
    still_ = 0;
    if (!plan_anew(now, solids) && plans_ == kMostPlans) give_up();
  }
  return command;
}

std::string ReachTask::words() const {
  switch (state_) {
    case State::Goes:
      return "The robot " + std::string(name(legs_[leg_].kind)) + ".";
    case State::Waits:
      return "The robot waits: something is too near to go on.";
    case State::Arrived:
      return "The hand is at its goal.";
    case State::GivenUp:
      return why_;
  }
  return "";
}

bool ReachTask::plan_anew(const BodyJoints& now, std::span<const Solid> solids) {
  if (plans_ == kMostPlans) {
    why_ = "The robot has tried several ways, and none led to the goal.";
    return false;
  }
  const auto failed = static_cast<std::uint64_t>(plans_);
  ReachRules rules = rules_;
  rules.skip += kTriedPlaces * failed;
  ReachPlan found = plan_reach(body_, now, hand_W_, solids, seed_ + failed, rules);
  ++plans_;
  if (found.legs.empty()) {
    why_ = std::move(found.why);
    return false;
  }
  legs_ = std::move(found.legs);
  leg_ = 0;
  state_ = State::Goes;
  follower_.begin(legs_.front().path);
  return true;
}

void ReachTask::next_leg(const BodyJoints& now, std::span<const Solid> solids) {
  ++leg_;
  ReachLeg& leg = legs_[leg_];
  if (leg_ + 1 == legs_.size() && leg.kind == ReachLeg::Kind::Arm) {
    // The base stands a little off its place: the hand's goal counts, not the joints' of the plan.
    auto last = plan_last_reach(body_, now, hand_W_, solids, seed_, rules_);
    if (!last) {
      if (!plan_anew(now, solids)) give_up();
      return;
    }
    leg = std::move(*last);
  } else {
    leg.path.front() = now;
  }
  follower_.begin(leg.path);
}

void ReachTask::give_up() {
  legs_.clear();
  state_ = State::GivenUp;
}

}  // namespace algo
