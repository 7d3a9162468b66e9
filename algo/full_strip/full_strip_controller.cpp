// algo/full_strip/full_strip_controller.cpp: one tick, layer by layer.
#include "algo/full_strip/full_strip_controller.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "algo/driving.hpp"
#include "algo/strip/strip_law.hpp"

namespace algo {
namespace {

constexpr double kAtEnd = 0.15;       // [m] from the end of a strip that ends beside its goal
constexpr double kStopShort = 0.35;   // [m] before the place where the strip is broken
constexpr double kStuckTime = 2.5;    // [s] without progress: the strip is dropped
constexpr double kPatience = 1.2;     // [s] without progress until it looks for a manoeuvre
constexpr double kTurnsOnSpot = 0.1;  // [rad/s] slower does not count as turning

constexpr auto kParameters = std::to_array<const ParameterInfo*>({&kRepulsionGain,
                                                                  &kContractionGain,
                                                                  &kSafetyDistance,
                                                                  &kBreakRoom,
                                                                  &kPlanPeriod,
                                                                  &kNearestGoal,
                                                                  &kMaxSpeed,
                                                                  &kMaxTurnRate,
                                                                  &kHeadingGain,
                                                                  &kGoalReach});

/// True if a return lies at the robot's centre. No command can help then.
bool stands_on_a_return(const Scene& scene) {
  return (scene.left && scene.left->distance <= 0) || (scene.right && scene.right->distance <= 0);
}

}  // namespace

ParameterList FullStripController::parameters() {
  return kParameters;
}

void FullStripController::begin(const RunFacts& run) {
  drawn_ = run.map;
  if (drawn_) route_.hold(*drawn_);
}

void FullStripController::reset(const Pose2& start_W) {
  senses_.reset(start_W);
  route_.reset();
  narrow_place_.reset();
  recovery_.reset();
  giving_way_.reset();
  progress_.restart({0, 0}, 0);
  under_way_.reset();
  course_ = {};
  state_ = kNone;
}

/// Takes the new map for what it has seen, and the goal for a new one.
void FullStripController::move(const MapMove& move, const Pose2& here_W) {
  if (stage_.hull().half_width() <= 0) return reset(here_W);  // it has not driven yet
  senses_.move(move, here_W, stage_.hull());
  route_.clear_goal();
}

/// Forgets what it was doing and for how long, but not the strip: another behaviour has driven.
void FullStripController::forget_attempts(const ControlInput& in) {
  narrow_place_.reset();
  recovery_.reset();
  giving_way_.reset();
  progress_.restart(in.odometry.pose.position(), in.stamp);
  course_ = {.command = in.odometry.twist};
}

void FullStripController::prepare(const ControlInput& in, const Parameters& parameters) {
  if (!stage_.hull().is_of(*in.spec)) stage_.set_hull(HullCheck(*in.spec));
  limits_ = limits_of(*in.spec);
  limits_.max_v = std::min(parameters[kMaxSpeed], limits_.max_v);
  limits_.max_omega = std::min(parameters[kMaxTurnRate], limits_.max_omega);
  under_way_.fit(in.spec->command_delay, in.dt);
}

RouteSettings FullStripController::route_settings(const Parameters& parameters) const {
  RouteSettings settings;
  settings.strip.contraction = parameters[kContractionGain];
  settings.strip.repulsion = parameters[kRepulsionGain];
  settings.strip.rest_distance = std::min(parameters[kSafetyDistance], LocalMap::kReach);
  settings.half_width = stage_.hull().half_width();
  settings.round = stage_.hull().is_round();
  settings.max_v = limits_.max_v;
  settings.break_room = parameters[kBreakRoom];
  settings.plan_period = parameters[kPlanPeriod];
  return settings;
}

void FullStripController::take_goal(const ControlInput& in) {
  if (!route_.goal_W() || *route_.goal_W() != in.goal->position_W) {
    route_.set_goal(in.goal->position_W, in.stamp);
    senses_.forget_old();
    forget_attempts(in);
  } else if (in.interrupted) {
    forget_attempts(in);
  }
}

/// True if an obstacle stands on the goal and the robot can come no nearer, or must not try.
bool FullStripController::ends_here(const ControlInput& in, const Parameters& parameters) const {
  if (!route_.goal_taken(parameters[kGoalReach])) return false;
  if (parameters[kNearestGoal] == 0) return true;
  return (route_.strip().end_W() - in.odometry.pose.position()).norm() < kAtEnd;
}

/// Drops the strip and backs off after a long time without progress.
void FullStripController::watch_progress(const ControlInput& in) {
  const bool turning = state_ == kTurning && std::abs(in.odometry.twist.omega) > kTurnsOnSpot;
  const bool busy = turning || narrow_place_.driving() || route_.waits_for_plan();
  progress_.see(in.odometry.pose.position(), in.stamp, busy);
  const double patience = ProgressWatch::time_for(kStuckTime, limits_.max_v);
  if (progress_.without_progress(in.stamp) < patience) return;
  route_.give_up(in.stamp);
  progress_.excuse_progress(in.stamp);
  recovery_.begin_backing(in.stamp);
}

/// The next command of the present manoeuvre; nothing if it is over or no longer free.
std::optional<StripCommand> FullStripController::carry_on(const StageInput& stage,
                                                          const ControlInput& in) {
  if (!narrow_place_.driving()) return std::nullopt;
  const auto twist = narrow_place_.next(stage, stage_, weighed_);
  if (twist) return StripCommand{*twist, kManeuvering};
  progress_.excuse_place(in.stamp);
  return std::nullopt;
}

/// Along the strip, or by a manoeuvre to a place farther along it.
std::optional<StripCommand> FullStripController::follow(const StageInput& stage,
                                                        const ControlInput& in) {
  const Pose2& here = in.odometry.pose;
  const auto look = [&] {
    narrow_place_.look(stage, stage_.hull(), here, in.odometry.twist.v, in.stamp);
  };
  if (const auto twist = stage_.follow(stage, weighed_)) {
    const bool turning = twist->v == 0 && twist->omega != 0;
    const double patience = ProgressWatch::time_for(kPatience, limits_.max_v);
    if (progress_.in_place(in.stamp) > patience) look();
    if (*twist == Twist2{} && route_.broken_at() >= 0) return std::nullopt;
    return StripCommand{*twist, turning ? kTurning : kFollowing};
  }
  look();
  if (const auto command = carry_on(stage, in)) return command;
  if (narrow_place_.worth_waiting(in.stamp)) return StripCommand{{}, kBlocked};
  return std::nullopt;
}

StripCommand FullStripController::recover(const StageInput& stage, const ControlInput& in) {
  const auto command = recovery_.next(stage, stage_, in.odometry.twist.v, in.stamp, weighed_);
  if (!command) return {{}, route_.waits_for_plan() ? kPlanning : kBlocked};
  if (recovery_.begins_escape()) narrow_place_.reset();
  return *command;
}

StageInput FullStripController::stage_input(const ControlInput& in) const {
  StageInput stage;
  stage.map = &senses_.map();
  stage.strip = &route_.strip();
  stage.state = under_way_.state_when_acting({in.odometry.pose, in.odometry.twist}, limits_, in.dt);
  stage.limits = limits_;
  stage.course = course_;
  stage.dt = in.dt;
  stage.close_W = &senses_.close_W();
  if (route_.broken_at() >= 0) stage.stop_at = std::max(0.0, route_.broken_at() - kStopShort);
  return stage;
}

/// Turns towards the place where the way was shut, if it was.
Twist2 FullStripController::watch(const ControlInput& in, const Parameters& parameters) const {
  if (!route_.watched_W()) return {};
  const Vec2 way_W = *route_.watched_W() - in.odometry.pose.position();
  return turn_to(
      in.odometry.pose, SetGoal{*route_.watched_W(), std::atan2(way_W.y(), way_W.x())}, parameters);
}

StripCommand FullStripController::drive(const StageInput& stage,
                                        const ControlInput& in,
                                        const Parameters& parameters) {
  const auto proven = [&](const Twist2& wanted) {
    return stage_.proven(stage, wanted, weighed_).value_or(Twist2{});
  };
  const double to_goal = (in.goal->position_W - in.odometry.pose.position()).norm();
  if (to_goal < parameters[algo::kGoalReach]) {
    progress_.excuse_progress(in.stamp);
    return {proven(turn_to(in.odometry.pose, *in.goal, parameters)), kNone};
  }
  if (const auto command = giving_way_.next(
          stage, stage_.hull(), senses_.tracker(), in, under_way_.lead(in.dt), weighed_)) {
    narrow_place_.stop_driving();
    progress_.excuse_progress(in.stamp);
    progress_.excuse_place(in.stamp);
    return *command;
  }
  if (ends_here(in, parameters)) {
    progress_.excuse_progress(in.stamp);
    return {proven({}), kGoalTaken};
  }
  if (route_.no_way() && route_.strip().empty()) {
    progress_.restart(in.odometry.pose.position(), in.stamp);
    recovery_.reset();
    return {proven(watch(in, parameters)), kNoWay};
  }
  watch_progress(in);
  if (recovery_.active(in.stamp) || route_.strip().empty()) return recover(stage, in);
  if (const auto command = carry_on(stage, in)) return *command;
  if (const auto command = follow(stage, in)) return *command;
  return recover(stage, in);
}

/// The command for the base: as gentle as the robot's jerk asks, if that is safe too.
Twist2 FullStripController::gentle(const StageInput& stage, const StripCommand& command) {
  const Twist2 ramped = ramped_turn(course_, command.twist, limits_, stage.dt);
  if (!is_hard(course_, ramped, limits_, stage.dt) || command.urgent) return ramped;
  const Twist2 softer = eased(course_, ramped, limits_, stage.dt);
  return stage_.proven(stage, softer, weighed_).value_or(ramped);
}

void FullStripController::update(const ControlInput& in,
                                 const Parameters& parameters,
                                 ControlOutput& out) {
  out.clear();
  weighed_.clear();
  if (!all_finite(in, parameters) || stands_on_a_return(*in.scene)) return;
  prepare(in, parameters);
  senses_.update(in, stage_.hull(), among_moving_);
  if (!in.goal) {
    route_.clear_goal();
    state_ = kNone;
    course_ = {};
    under_way_.send({});
    return;
  }
  take_goal(in);
  route_.update(route_settings(parameters), plan_world(), in.odometry.pose.position(), in.stamp);
  if (route_.doubts()) senses_.forget_doubtful();
  const StageInput stage = stage_input(in);
  const StripCommand command = drive(stage, in, parameters);
  state_ = command.state;
  out.twist = gentle(stage, command);
  hard_ = is_hard(course_, out.twist, limits_, in.dt);
  course_ = followed(course_, out.twist, in.dt);
  out.pass_W = weighed_.pass_W;
  under_way_.send(out.twist);
  report(in, out);
}

}  // namespace algo
