// algo/full_strip/full_strip_controller.cpp: one tick, layer by layer.
#include "algo/full_strip/full_strip_controller.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "algo/driving.hpp"
#include "algo/strip/strip_law.hpp"

namespace algo {
namespace {

constexpr std::array<double, 3> kRoom{0.065, 0.035, 0.010};  // [m] beside the hull, level by level
constexpr int kExpansions = 400;                             // of the planner in a tick
constexpr int kExpansionsNow = 1200;                         // if there is no strip to follow
constexpr double kOtherShare = 0.9;   // a new strip below this share of the old cost replaces it,
constexpr double kNearer = 0.5;       // [m] or if it ends this much nearer to the goal,
constexpr double kNearerTaken = 0.1;  // [m] or this much if an obstacle stands on the goal;
constexpr double kAtGoal = 1e-6;      // [m] or if it ends at the goal and the old one does not
constexpr int kSweepsNew = 15;        // of a new strip
constexpr int kSweeps = 5;            // in a tick
constexpr double kAtEnd = 0.15;       // [m] from the end of a strip that ends beside its goal
constexpr double kStopShort = 0.35;   // [m] before the place where the strip is broken
constexpr double kStuckTime = 2.5;    // [s] without progress: the strip is dropped
constexpr double kStuckWay = 0.15;    // [m]
constexpr double kBackTime = 1.0;     // [s]
constexpr double kTrace = 0.25;       // [m] around an obstacle found moving: its traces in the map
constexpr double kTryTight = 4.0;     // [s] for which it tries for a near goal without room
constexpr double kPatience = 1.2;     // [s] without progress until it looks for a manoeuvre
constexpr double kSearchEvery = 1.0;  // [s] after a search that found nothing
constexpr int kManeuverExpansions = 150;   // in a tick
constexpr double kManeuverMargin = 0.031;  // [m] of room on the way
constexpr std::size_t kNearest = 4;        // nodes ahead: a manoeuvre ends from here to kFarthest;
constexpr std::size_t kFarthest = 11;
constexpr std::size_t kAimedNode = 7;              // its search aims here
constexpr double kOnStrip = 0.10;                  // [m]
constexpr double kAlongStrip = 0.35;               // [rad]
constexpr double kLastLeg = 2 * LocalMap::kReach;  // [m] to the goal
constexpr double kGives = 0.08;  // [m] by which the strip stays inside its rest distance

constexpr ParameterInfo kBreakRoom{
    .name = "full_strip.break_room",
    .label = "Break room",
    .unit = "m",
    .min = 0.0,
    .max = 0.05,
    .step = 0.005,
    .initial = 0.02,
    .help = "How much narrower the strip may become than what was planned before it breaks."};
constexpr ParameterInfo kPlanPeriod{.name = "full_strip.plan_period",
                                    .label = "Planning period",
                                    .unit = "s",
                                    .min = 0.1,
                                    .max = 5.0,
                                    .step = 0.05,
                                    .initial = 0.25,
                                    .help = "Time between two searches for a way over the map."};
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

void FullStripController::reset(const Pose2& start_W) {
  map_.reset(start_W.position());
  tracker_.reset();
  forget_way();
  way_since_ = 0;
  goal_W_.reset();
  broken_at_ = -1;
  next_plan_ = 0;
  state_ = kNone;
  back_until_ = -1;
  escape_until_ = -1;
  placed_ = false;
  under_way_.clear();
  points_.reset();
  path_W_.clear();
}

/// Forgets everything about the way to the goal.
void FullStripController::forget_way() {
  strip_.clear();
  planner_.reset();
  search_.reset();
  maneuver_.reset();
  space_time_.reset();
  level_ = 0;
  no_way_ = false;
  goal_taken_ = false;
  tight_since_.reset();
}

/// Forgets what it was doing and for how long, but not the strip: another behaviour has driven.
void FullStripController::forget_attempts(const ControlInput& in) {
  search_.reset();
  maneuver_.reset();
  space_time_.reset();
  back_until_ = -1;
  escape_until_ = -1;
  progress_W_ = in.odometry.pose.position();
  progress_at_ = in.stamp;
  way_W_ = progress_W_;
  way_since_ = in.stamp;
}

double FullStripController::least_clearance() const {
  return stage_.hull().half_width() + kRoom[level_];
}

void FullStripController::prepare(const ControlInput& in, const Parameters& parameters) {
  if (!stage_.hull().is_of(*in.spec)) stage_.set_hull(HullCheck(*in.spec));
  limits_ = limits_of(*in.spec);
  limits_.max_v = std::min(parameters[kMaxSpeed], limits_.max_v);
  limits_.max_omega = std::min(parameters[kMaxTurnRate], limits_.max_omega);
  settings_.contraction = parameters[kContractionGain];
  settings_.repulsion = parameters[kRepulsionGain];
  settings_.rest_distance = std::min(parameters[kSafetyDistance], LocalMap::kReach);
  break_room_ = parameters[kBreakRoom];
  plan_period_ = parameters[kPlanPeriod];
  settings_.least_clearance = least_clearance() - break_room_;
}

/// Enters a new scan into the map, each beam from the pose at which it was fired.
void FullStripController::sense(const ControlInput& in) {
  const Pose2& here = in.odometry.pose;
  points_.follow(here, in.stamp);
  map_.follow(here.position());
  if (!placed_) stage_.hull().take_place(map_.seen(), here);
  placed_ = true;
  stage_.hull().stand_on(map_.seen(), here);
  const LaserScan& scan = in.scene->scan;
  if (in.scene->fresh && scan.size() > 0) {
    const Pose2 sensor_W = points_.map(scan);
    if (among_moving_) tracker_.update(scan, sensor_W, points_.points_W());
    map_.insert(scan, sensor_W, points_.points_W(), tracker_);
    forget_traces(in);
  }
  tracker_.predict(in.stamp);
}

/// Frees impossible obstacles from the map: on the way of an obstacle found moving, and inside the
/// robot's own hull, which no sensor looks at.
void FullStripController::forget_traces(const ControlInput& in) {
  for (const Track& track : tracker_.just_found()) {
    const Vec2 way_W = track.velocity_W * track.age;
    const double length = way_W.norm();
    const double reach = track.radius + kTrace;
    map_.erase_near(track.position_W, reach + length, [&](const Vec2& point_W) {
      const Vec2 d = point_W - track.position_W;
      const double back = length > 0 ? std::clamp(-d.dot(way_W) / (length * length), 0.0, 1.0) : 0;
      return (d + back * way_W).squaredNorm() < reach * reach;
    });
  }
  const Pose2& here = in.odometry.pose;
  map_.erase_near(here.position(), in.spec->radius, [&](const Vec2& point_W) {
    return stage_.hull().covers(here, point_W);
  });
}

/// If the goal is nearer to an obstacle than the strip would keep, that distance is allowed: on the
/// last leg the strip keeps it, instead of swinging out only to swing in again.
void FullStripController::ease_last_leg(const Vec2& here_W) {
  if ((*goal_W_ - here_W).norm() > kLastLeg) return;
  const double room = std::max(map_.distance(*goal_W_) + kGives, least_clearance());
  settings_.rest_distance = std::min(settings_.rest_distance, room);
}

/// The deliberative layer: one portion of a search each tick, a new search every plan_period_.
void FullStripController::plan(const ControlInput& in) {
  const Vec2 here = in.odometry.pose.position();
  if (planner_.state() != Planner::State::Searching && in.stamp >= next_plan_) {
    // Low clearance at the goal does not mean that an obstacle stands on it.
    while (level_ + 1 < kRoom.size() && map_.distance(*goal_W_) < least_clearance() &&
           map_.seen().seen(*goal_W_)) {
      ++level_;
    }
    const bool try_tight = !tight_since_ || in.stamp - *tight_since_ < time_for(kTryTight);
    planner_.start(map_, here, *goal_W_, least_clearance(), try_tight);
    if (planner_.goal_tight() && !tight_since_) tight_since_ = in.stamp;
    next_plan_ = in.stamp + plan_period_;
  }
  if (planner_.state() != Planner::State::Searching) return;
  const bool urgent = strip_.empty() || broken_at_ >= 0;
  switch (planner_.search(map_, urgent ? kExpansionsNow : kExpansions)) {
    case Planner::State::Found:
      take_plan(in);
      return;
    case Planner::State::NoWay:
      if (level_ + 1 < kRoom.size()) {
        ++level_;
        next_plan_ = in.stamp;
      } else {
        no_way_ = true;
        level_ = 0;
      }
      return;
    default:
      return;
  }
}

/// Makes the plan the strip if there is none, or if it is clearly better than the present one.
void FullStripController::take_plan(const ControlInput& in) {
  no_way_ = false;
  planner_.path(path_W_);
  straighten(map_, settings_.rest_distance, path_W_);
  candidate_.lay(path_W_);
  candidate_.follow(in.odometry.pose.position());
  StripSettings settings = settings_;
  settings.least_clearance = least_clearance() - break_room_;
  candidate_.relax(map_, settings, kSweepsNew);
  if (candidate_.broken_at(map_, settings) >= 0) {
    // Relaxing moved it off its way: take the plan as it is.
    candidate_.lay(path_W_);
    candidate_.follow(in.odometry.pose.position());
  }
  // A strip may end short of the goal, if the goal lay beyond the map or an obstacle stands on it.
  // It may well cost less than one that ends nearer.
  const bool was_taken = std::exchange(goal_taken_, planner_.goal_taken());
  const double nearer = goal_taken_ || was_taken ? kNearerTaken : kNearer;
  const bool better = strip_.empty() || broken_at_ >= 0 ||
                      left(candidate_) < left(strip_) - nearer ||
                      (left(candidate_) < kAtGoal && left(strip_) >= kAtGoal) ||
                      candidate_.cost(map_) < kOtherShare * strip_.cost(map_);
  if (better) {
    std::swap(strip_, candidate_);
    broken_at_ = -1;
  }
  level_ = 0;  // the next search begins with the widest again
}

/// [m] Distance from the end of `strip` to the goal.
double FullStripController::left(const NodeStrip& strip) const {
  return (strip.end_W() - *goal_W_).norm();
}

/// True if an obstacle stands on the goal and the robot can come no nearer, or must not try.
bool FullStripController::ends_here(const ControlInput& in, const Parameters& parameters) const {
  if (!goal_taken_ || strip_.empty() || left(strip_) < parameters[kGoalReach]) return false;
  if (parameters[kNearestGoal] == 0) return true;
  return (strip_.end_W() - in.odometry.pose.position()).norm() < kAtEnd;
}

/// The reactive layer: fits the strip to the robot and the map.
void FullStripController::stretch(const ControlInput& in) {
  if (strip_.empty()) return;
  strip_.follow(in.odometry.pose.position());
  strip_.relax(map_, settings_, kSweeps);
  StripSettings narrow = settings_;
  narrow.least_clearance = stage_.hull().half_width() + kRoom.back() - break_room_;
  broken_at_ = strip_.broken_at(map_, narrow);
  if (broken_at_ >= 0) next_plan_ = std::min(next_plan_, in.stamp);
}

/// The state when a command given now begins to act.
MotionState FullStripController::when_acting(const ControlInput& in) const {
  MotionState state{in.odometry.pose, in.odometry.twist};
  for (const Twist2& command : under_way_) state = advanced(state, command, limits_, in.dt);
  return state;
}

void FullStripController::remember(const Twist2& command) {
  if (under_way_.empty()) return;
  std::rotate(under_way_.begin(), under_way_.begin() + 1, under_way_.end());
  under_way_.back() = command;
}

/// `patience` [s], or three times what a slow robot needs for the distance that counts as progress.
double FullStripController::time_for(double patience) const {
  return std::max(patience, 3 * kStuckWay / limits_.max_v);
}

void FullStripController::watch_progress(const ControlInput& in) {
  const Vec2 here = in.odometry.pose.position();
  const bool turning = state_ == kTurning && std::abs(in.odometry.twist.omega) > 0.1;
  if ((here - way_W_).norm() > kStuckWay) {
    way_W_ = here;
    way_since_ = in.stamp;
  }
  if (turning || maneuver_.active() || (here - progress_W_).norm() > kStuckWay) {
    progress_W_ = here;
    progress_at_ = in.stamp;
  }
  if (in.stamp - progress_at_ < time_for(kStuckTime)) return;
  strip_.clear();
  planner_.reset();
  next_plan_ = in.stamp;
  progress_at_ = in.stamp;
  back_until_ = in.stamp + kBackTime;
}

/// Among moving obstacles the beam search decides instead of the strip's pursuit. The strip still
/// gives the direction.
std::optional<Twist2> FullStripController::give_way(const StageInput& stage,
                                                    const ControlInput& in) {
  SpaceTimeInput search;
  search.map = &map_;
  search.hull = &stage_.hull();
  search.spec = in.spec;
  search.tracks = &tracker_.moving();
  search.standing = &tracker_.standing();
  search.lead = in.dt * static_cast<double>(under_way_.size());
  search.state = stage.state;
  search.limits = limits_;
  search.stamp = in.stamp;
  search.looks_back = tracker_.looks_back();
  if (!space_time_.needed(search, strip_)) return std::nullopt;
  // The farthest visible point of the strip.
  search.carrot_W = in.goal->position_W;
  if (!strip_.empty()) {
    const Recycled<Node>& nodes = strip_.nodes();
    std::size_t carrot = 1;
    for (std::size_t i = 4; i < nodes.size() + 3; i += 4) {
      const std::size_t at = std::min(i, nodes.size() - 1);
      if (!map_.sees(nodes[0].position_W, nodes[at].position_W, stage_.hull().half_width())) break;
      carrot = at;
    }
    search.carrot_W = nodes[carrot].position_W;
    search.beyond = static_cast<double>(nodes.size() - 1 - carrot) * NodeStrip::kSpacing;
  }
  const Twist2 twist = space_time_.search(search, weighed_);
  weighed_.pass_W = search.carrot_W;
  maneuver_.reset();
  progress_at_ = in.stamp;
  way_since_ = in.stamp;
  state_ = space_time_.clear() ? kGivingWay : kCornered;
  if (space_time_.clear() && twist.v > 0.1) state_ = kFollowing;
  return advanced(search.state, twist, limits_, in.dt).twist;
}

Twist2 FullStripController::recover(const StageInput& stage, const ControlInput& in) {
  if (in.stamp < back_until_) {
    if (const auto twist = stage_.back_off(stage, weighed_)) {
      state_ = kBackingOff;
      return *twist;
    }
  }
  // An escape runs to its end: starting and stopping it each tick would lead nowhere.
  if (in.stamp < escape_until_) {
    if (stage_.still_escapes(stage, escape_, escape_until_ - in.stamp, weighed_)) {
      state_ = kEscaping;
      return escape_;
    }
    escape_until_ = -1;
  }
  const bool still = std::abs(in.odometry.twist.v) < 0.05;
  if (still) {
    if (const auto twist = stage_.escape(stage, weighed_)) {
      escape_ = *twist;
      escape_until_ = in.stamp + VelocityStage::kEscape;
      maneuver_.reset();
      search_.reset();
      state_ = kEscaping;
      return escape_;
    }
  }
  state_ = no_way_ ? kNoWay : kBlocked;
  return {};
}

/// Searches, a portion each tick, for a way to a pose on the strip ahead that points along it.
void FullStripController::look_for_maneuver(const ControlInput& in) {
  const Recycled<Node>& nodes = strip_.nodes();
  if (nodes.size() < 3) return;
  const Pose2& here = in.odometry.pose;
  if (search_.state() == ManeuverSearch::State::NoWay && in.stamp < next_search_) return;
  if (search_.state() != ManeuverSearch::State::Searching) {
    const bool moving = std::abs(in.odometry.twist.v) > 0.05;
    if (moving) return;
    const std::size_t aim = std::min(nodes.size() - 1, kAimedNode);
    search_.start(here, nodes[aim].position_W, kManeuverMargin);
    next_search_ = in.stamp + kSearchEvery;
  }
  const auto arrived = [&](const Pose2& pose_W) {
    const std::size_t end = std::min(nodes.size() - 1, kFarthest);
    for (std::size_t i = std::min(end - 1, kNearest); i < end; ++i) {
      const Vec2 way = nodes[i + 1].position_W - nodes[i].position_W;
      if ((nodes[i].position_W - pose_W.position()).squaredNorm() > kOnStrip * kOnStrip) continue;
      const double error = std::atan2(way.y(), way.x()) - pose_W.heading;
      if (std::abs(wrap_angle(error)) < kAlongStrip) return true;
    }
    return false;
  };
  if (search_.search(map_, stage_.hull(), arrived, kManeuverExpansions) ==
      ManeuverSearch::State::Found) {
    maneuver_.start(search_.pieces());
    search_.reset();
  }
}

/// The next command of the present manoeuvre; nothing if it is over or no longer free.
std::optional<Twist2> FullStripController::carry_on(const StageInput& stage,
                                                    const ControlInput& in) {
  const auto wanted = maneuver_.next(stage.state.pose_W, limits_);
  if (wanted) {
    if (const auto twist = stage_.proven(stage, *wanted, weighed_)) {
      state_ = kManeuvering;
      return twist;
    }
  }
  maneuver_.reset();
  way_since_ = in.stamp;
  return std::nullopt;
}

Twist2 FullStripController::drive(const ControlInput& in, const Parameters& parameters) {
  StageInput stage;
  stage.map = &map_;
  stage.strip = &strip_;
  stage.state = when_acting(in);
  stage.limits = limits_;
  stage.dt = in.dt;
  if (broken_at_ >= 0) stage.stop_at = std::max(0.0, broken_at_ - kStopShort);

  const double to_goal = (in.goal->position_W - in.odometry.pose.position()).norm();
  if (to_goal < parameters[algo::kGoalReach]) {
    state_ = kNone;
    progress_at_ = in.stamp;
    return stage_.proven(stage, turn_to(in.odometry.pose, *in.goal, parameters), weighed_)
        .value_or(Twist2{});
  }
  if (const auto twist = give_way(stage, in)) return *twist;
  if (ends_here(in, parameters)) {
    state_ = kGoalTaken;
    progress_at_ = in.stamp;
    return stage_.proven(stage, {}, weighed_).value_or(Twist2{});
  }
  watch_progress(in);
  if (std::max(back_until_, escape_until_) > in.stamp || strip_.empty()) {
    return recover(stage, in);
  }
  if (maneuver_.active()) {
    if (const auto twist = carry_on(stage, in)) return *twist;
  }
  if (const auto twist = stage_.follow(stage, weighed_)) {
    const bool turning = twist->v == 0 && twist->omega != 0;
    state_ = turning ? kTurning : kFollowing;
    if (in.stamp - way_since_ > time_for(kPatience)) look_for_maneuver(in);
    if (*twist != Twist2{} || broken_at_ < 0) return *twist;
  } else {
    look_for_maneuver(in);
    if (maneuver_.active()) {
      if (const auto way = carry_on(stage, in)) return *way;
    }
    const bool searching = search_.state() == ManeuverSearch::State::Searching;
    if (searching && in.stamp < next_search_) {
      state_ = kBlocked;
      return {};
    }
  }
  return recover(stage, in);
}

void FullStripController::update(const ControlInput& in,
                                 const Parameters& parameters,
                                 ControlOutput& out) {
  out.clear();
  weighed_.clear();
  if (!all_finite(in, parameters) || stands_on_a_return(*in.scene)) return;
  const auto delay = static_cast<std::size_t>(std::lround(in.spec->command_delay / in.dt));
  if (under_way_.size() != delay) under_way_.assign(delay, {});
  prepare(in, parameters);
  sense(in);
  if (!in.goal) {
    strip_.clear();
    goal_W_.reset();
    state_ = kNone;
    remember({});
    return;
  }
  if (!goal_W_ || *goal_W_ != in.goal->position_W) {
    goal_W_ = in.goal->position_W;
    forget_way();
    forget_attempts(in);
    next_plan_ = in.stamp;
  } else if (in.interrupted) {
    forget_attempts(in);
  }
  ease_last_leg(in.odometry.pose.position());
  stretch(in);
  plan(in);
  out.twist = drive(in, parameters);
  out.pass_W = weighed_.pass_W;
  remember(out.twist);
  report(in, out);
}

}  // namespace algo
