#include "algo/arm/reach_task.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
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
  if (kind == ReachLeg::Kind::Follow) return command.state != FollowState::Waits;
  if (kind == ReachLeg::Kind::Arm) return command.rates.cwiseAbs().maxCoeff() > kStandsStill;
  return std::abs(command.base.v) > kStandsStill || std::abs(command.base.omega) > kStandsStill;
}

}  // namespace

ReachTask::ReachTask(const MobileArm& body, const BodyLimits& limits, const ReachRules& rules)
    : body_(body),
      rules_(rules),
      follower_(body, limits, {}, {.margin = rules.arm.margin - kPlay}),
      path_(body, limits) {}

void ReachTask::begin(const BodyJoints& now,
                      const ReachGoal& goal,
                      std::span<const Solid> solids,
                      std::uint64_t seed) {
  goal_ = goal;
  seed_ = seed;
  plans_ = 0;
  still_ = 0;
  stage_ = Stage::There;
  path_.reset();
  followed_ = 0;
  legs_.clear();
  ask(way(), now, solids);
}

ReachQuestion::Kind ReachTask::way() const {
  using Kind = ReachQuestion::Kind;
  if (goal_.carries) return Kind::Carry;
  if (stage_ == Stage::Back) return Kind::Return;
  if (stage_ == Stage::Path) return Kind::Follow;
  return goal_.base_stays ? Kind::Last : Kind::Whole;
}

void ReachTask::ask(ReachQuestion::Kind kind,
                    const BodyJoints& now,
                    std::span<const Solid> solids) {
  const auto failed = static_cast<std::uint64_t>(plans_);
  const bool whole = kind == ReachQuestion::Kind::Whole;
  question_ =
      ReachQuestion{.kind = kind,
                    .now = now,
                    .hand_W = goal_.hand_W,
                    .path_W = kind == ReachQuestion::Kind::Follow ? path_left() : goal_.path_W,
                    .base_stays = goal_.base_stays,
                    .base_goal = goal_.then.value_or(SetGoal{}),
                    .seed = whole ? seed_ + failed : seed_,
                    .rules = rules_};
  const auto stands = [](const Solid& solid) { return solid.velocity_W.isZero(); };
  std::ranges::copy_if(solids, std::back_inserter(question_->solids), stands);
  question_->rules.arm_angle = goal_.arm_angle;
  if (whole) question_->rules.skip += kTriedPlaces * failed;
  state_ = State::Plans;
}

void ReachTask::ask_anew(const BodyJoints& now, std::span<const Solid> solids) {
  if (plans_ < kMostPlans) return ask(way(), now, solids);
  why_ = "The robot has tried several ways, and none led to the goal.";
  give_up();
}

void ReachTask::take(ReachPlan found, const BodyJoints& now, std::span<const Solid> solids) {
  const bool last = question_->kind == ReachQuestion::Kind::Last;
  question_.reset();
  still_ = 0;
  if (!last || way() == ReachQuestion::Kind::Last) return take_whole(std::move(found), now);
  if (found.legs.empty()) {
    legs_.clear();
    return ask_anew(now, solids);
  }
  legs_[leg_] = std::move(found.legs.front());
  ++changes_;
  follow(now);
}

/// Where there is no other way, the planned one may become free.
void ReachTask::take_whole(ReachPlan found, const BodyJoints& now) {
  ++plans_;
  if (!found.legs.empty()) {
    legs_ = std::move(found.legs);
    leg_ = 0;
    ++changes_;
    return follow(now);
  }
  why_ = std::move(found.why);
  const bool has_way = !legs_.empty() && leg_ < legs_.size();
  if (!has_way || plans_ >= kMostPlans) return give_up();
  state_ = State::Waits;
}

void ReachTask::follow(const BodyJoints& now) {
  state_ = State::Goes;
  std::vector<BodyJoints>& path = legs_[leg_].path;
  path.front() = now;
  if (legs_[leg_].kind != ReachLeg::Kind::Follow) return follower_.begin(path);
  followed_ += path_.done();
  path_.begin(path);
}

BodyCommand ReachTask::update(const BodyJoints& now,
                              std::span<const Solid> near,
                              std::span<const Solid> all,
                              double dt) {
  BodyCommand rest{.state = FollowState::Waits};
  if (question_ || state_ == State::GivenUp || legs_.empty()) return rest;
  BodyCommand command = step(now, near, dt);
  if (command.state == FollowState::Arrived && leg_ + 1 < legs_.size()) {
    next_leg(now, all);
    return {};
  }
  if (command.state == FollowState::Arrived && go_on(now, all)) return rest;
  if (command.state == FollowState::Arrived) {
    state_ = State::Arrived;
    still_ = 0;
    return command;
  }
  still_ = carries_on(command, legs_[leg_].kind) ? 0 : still_ + dt;
  state_ = still_ > 0 ? State::Waits : State::Goes;
  if (still_ > kPatience) {
    still_ = 0;
    ask_anew(now, all);
  }
  return command;
}

bool ReachTask::go_on(const BodyJoints& now, std::span<const Solid> solids) {
  if (goal_.carries || stage_ == Stage::Back) return false;
  const bool follows = stage_ == Stage::There && !goal_.path_W.empty();
  if (!follows && !goal_.then) return false;
  stage_ = follows ? Stage::Path : Stage::Back;
  plans_ = 0;
  still_ = 0;
  legs_.clear();
  ask(way(), now, solids);
  return true;
}

/// Along the present leg.
BodyCommand ReachTask::step(const BodyJoints& now, std::span<const Solid> near, double dt) {
  if (legs_[leg_].kind != ReachLeg::Kind::Follow) return follower_.update(now, near, dt);
  BodyCommand along = path_.update(now, near, dt);
  if (along.state == FollowState::Arrived) return along;
  BodyCommand command = follower_.kept_clear(now, along, near, true);
  if (along.state == FollowState::Waits) command.state = FollowState::Waits;
  return command;
}

std::vector<Vec3> ReachTask::path_left() const {
  double behind = followed_ + path_.done();
  std::vector<Vec3> left;
  Vec3 last = goal_.hand_W.translation();
  for (const Vec3& point : goal_.path_W) {
    behind -= (point - last).norm();
    if (behind < 0) left.push_back(point);
    last = point;
  }
  return left;
}

std::string ReachTask::words() const {
  switch (state_) {
    case State::Plans:
      return "The robot looks for a way.";
    case State::Goes:
      return "The robot " + std::string(name(legs_[leg_].kind)) + ".";
    case State::Waits:
      return "The robot waits: something is too near to go on.";
    case State::Arrived:
      if (goal_.carries) return "The robot is at its goal.";
      if (stage_ == Stage::Back) return "The robot is back from where its hand has been.";
      return stage_ == Stage::Path ? "The hand is at the end of its path."
                                   : "The hand is at its goal.";
    case State::GivenUp:
      return why_;
  }
  return "";
}

void ReachTask::next_leg(const BodyJoints& now, std::span<const Solid> solids) {
  ++leg_;
  // The base stands a little off its place: the hand's goal counts, not the joints' of the plan.
  const bool last = leg_ + 1 == legs_.size() && legs_[leg_].kind == ReachLeg::Kind::Arm;
  if (last) return ask(ReachQuestion::Kind::Last, now, solids);
  follow(now);
}

void ReachTask::give_up() {
  legs_.clear();
  leg_ = 0;
  ++changes_;
  state_ = State::GivenUp;
}

void answer_at_once(ReachTask& task,
                    const MobileArm& body,
                    const BodyJoints& now,
                    std::span<const Solid> solids) {
  while (const ReachQuestion* question = task.question()) {
    task.take(answer(body, *question), now, solids);
  }
}

}  // namespace algo
