// algo/full_strip/strip_route.cpp: plans, compares, and fits the strip.
#include "algo/full_strip/strip_route.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "algo/full_strip/progress_watch.hpp"

namespace algo {
namespace {

constexpr int kExpansions = 400;      // of the planner in a tick
constexpr int kExpansionsNow = 1600;  // if there is no strip to follow
constexpr double kOtherShare = 0.9;   // a new strip below this share of the old cost replaces it,
constexpr double kNearer = 0.5;       // [m] or if it goes on this much farther towards the goal,
constexpr double kNearerTaken = 0.1;  // [m] or this much if an obstacle stands on the goal;
constexpr double kAtGoal = 1e-6;      // [m] or if it ends at the goal and the old one does not
constexpr int kSweepsNew = 15;        // of a new strip
constexpr int kSweeps = 5;            // in a tick
constexpr double kTryTight = 4.0;     // [s] for which it tries for a near goal without room
constexpr double kLastLeg = 2 * LocalMap::kReach;  // [m] to the goal
constexpr double kGives = 0.08;   // [m] by which the strip stays inside its rest distance
constexpr double kSameWay = 0.6;  // [m] from the old strip's end: a path past it goes on from there
constexpr double kAgainAfter = 1.0;     // [s] after a search without a way
constexpr double kDoubtTime = 1.5;      // [s] for which the map drops what it doubts
constexpr double kDoubtWalls = 20;      // [s] for which walls of a known map may be gone
constexpr double kWatchFrom = 1.2;      // [m] before a place that was shut,
constexpr double kWatchTime = 20;       // [s]
constexpr double kThere = 0.3;          // [m]
constexpr std::uint8_t kLongSeen = 30;  // beams through a place that was free for long,
constexpr double kSeenBefore = 0.3;     // [m] on the strip from here
constexpr double kSeenBehind = 0.9;     // [m] to there

}  // namespace

void StripRoute::reset() {
  set_goal({0, 0}, 0);
  goal_W_.reset();
  path_ = {};
}

void StripRoute::set_goal(const Vec2& goal_W, double now) {
  goal_W_ = goal_W;
  strip_.clear();
  planner_.reset();
  failures_ = 0;
  closure_.reset();
  watch_.reset();
  aim_ = Aim::Goal;
  walls_ = DrawnWalls::Shut;
  doubted_until_ = now;
  doubts_ = false;
  goal_taken_ = false;
  tight_since_.reset();
  broken_at_ = -1;
  next_plan_ = now;
}

void StripRoute::clear_goal() {
  strip_.clear();
  goal_W_.reset();
}

void StripRoute::give_up(double now) {
  strip_.clear();
  planner_.reset();
  next_plan_ = now;
}

void StripRoute::update(const RouteSettings& settings,
                        const PlanWorld& world,
                        const Vec2& here_W,
                        double now) {
  settings_ = settings;
  doubts_ = false;
  settings_.strip.least_clearance = step_cost().least - settings_.break_room;
  ease_last_leg(world.map, here_W);
  stretch(world.map, here_W, now);
  note_closure(world);
  plan(world, here_W, now);
}

StepCost StripRoute::step_cost() const {
  return StepCost::of_hull(settings_.half_width, settings_.round);
}

Planner::Options StripRoute::plan_options() const {
  return {.cost = step_cost(), .exact = settings_.round, .walls = walls_};
}

/// [m] Distance from the end of `strip` to the goal.
double StripRoute::left(const NodeStrip& strip) const {
  return (strip.end_W() - *goal_W_).norm();
}

bool StripRoute::goal_taken(double reach) const {
  return goal_taken_ && !strip_.empty() && left(strip_) >= reach;
}

/// If the goal is nearer to an obstacle than the strip would keep, that distance is allowed: on the
/// last leg the strip keeps it, instead of swinging out only to swing in again.
void StripRoute::ease_last_leg(const LocalMap& map, const Vec2& here_W) {
  if ((*goal_W_ - here_W).norm() > kLastLeg) return;
  const double room = std::max(map.distance(*goal_W_) + kGives, step_cost().least);
  settings_.strip.rest_distance = std::min(settings_.strip.rest_distance, room);
}

/// The reactive layer: fits the strip to the robot and the map.
void StripRoute::stretch(const LocalMap& map, const Vec2& here_W, double now) {
  if (strip_.empty()) return;
  strip_.follow(here_W);
  strip_.relax(map, settings_.strip, kSweeps);
  strip_.centre(map, settings_.strip);
  broken_at_ = strip_.broken_at(map, settings_.strip);
  if (broken_at_ >= 0) next_plan_ = std::min(next_plan_, now);
}

/// The deliberative layer: one portion of a search each tick, a new search every plan_period.
void StripRoute::plan(const PlanWorld& world, const Vec2& here_W, double now) {
  if (planner_.state() != Planner::State::Searching && now >= next_plan_) {
    start_search(world, here_W, now);
  }
  if (planner_.state() != Planner::State::Searching) return;
  const bool urgent = strip_.empty() || broken_at_ >= 0;
  switch (planner_.search(world, urgent ? kExpansionsNow : kExpansions)) {
    case Planner::State::Found:
      if (aim_ == Aim::Goal) {
        if (watch_) strip_.clear();  // it leads elsewhere
        watch_.reset();
        closure_.reset();
      }
      if (aim_ != Aim::Reach) take_plan(world, here_W);
      return;
    case Planner::State::NoWay:
      fail(world, here_W, now);
      return;
    default:
      return;
  }
}

void StripRoute::start_search(const PlanWorld& world, const Vec2& here_W, double now) {
  aim_ = Aim::Goal;
  const double patience = ProgressWatch::time_for(kTryTight, settings_.max_v);
  if (now >= doubted_until_ && !no_way()) walls_ = DrawnWalls::Shut;
  Planner::Options options = plan_options();
  options.try_tight = !tight_since_ || now - *tight_since_ < patience;
  options.lenient = lenient();
  planner_.start(world, here_W, *goal_W_, options);
  if (planner_.goal_tight() && !tight_since_) tight_since_ = now;
  next_plan_ = now + settings_.plan_period;
}

/// Remembers where a strip broke at a place that had been free for long, before and behind it too:
/// a door has closed. Behind a wall that is seen for the first time, nothing was seen before.
void StripRoute::note_closure(const PlanWorld& world) {
  if (broken_at_ < 0 || strip_.empty() || watch_) return;
  double s = broken_at_ - kSeenBefore;
  while (s <= broken_at_ + kSeenBehind) {
    const Vec2 at_W = strip_.at(std::max(0.0, s));
    if (world.memory.crossings(BuildingMemory::cell_of(at_W)) < kLongSeen) return;
    s += NodeStrip::kSpacing;
  }
  closure_ = Watch{strip_.at(std::max(0.0, broken_at_ - kWatchFrom)), strip_.at(broken_at_), {}};
}

/// A search has found no way. The first one to the goal in a row makes the map drop its doubtful
/// cells. After the third, a lenient one, there is no way.
void StripRoute::fail(const PlanWorld& world, const Vec2& here_W, double now) {
  if (aim_ == Aim::Reach) {
    watch_ = Watch{planner_.closest_W(), *goal_W_, {}};
    search_for_watch(world, here_W);
    return;
  }
  if (aim_ == Aim::Watch) {
    watch_.reset();
    closure_.reset();
    next_plan_ = now + kAgainAfter;
    return;
  }
  if (doubt_walls(world, here_W, now)) return;
  if (failures_ < kSurely) ++failures_;
  if (failures_ == 1) {
    doubts_ = true;
    next_plan_ = now + kDoubtTime;
  }
  if (!no_way()) return;
  next_plan_ = now + kAgainAfter;
  wait_for_way(world, here_W, now);
}

/// The map may be wrong: if its walls leave no way, the robot drives to see whether they are there.
bool StripRoute::doubt_walls(const PlanWorld& world, const Vec2& here_W, double now) {
  if (world.drawn == nullptr || walls_ == DrawnWalls::Priced) return false;
  walls_ = DrawnWalls::Priced;
  doubted_until_ = now + kDoubtWalls;
  start_search(world, here_W, now);
  return true;
}

/// A door may open: the robot waits at one that it saw shut, for a while, and then at the place
/// within reach that is nearest to the goal.
void StripRoute::wait_for_way(const PlanWorld& world, const Vec2& here_W, double now) {
  if (!watch_) {
    strip_.clear();
    broken_at_ = -1;
    path_.points_W.clear();
    watch_ = closure_;
  }
  if (!watch_) {
    aim_ = Aim::Reach;
    planner_.start(world, *goal_W_, here_W, plan_options());
    return;
  }
  if (!watch_->since && (watch_->from_W - here_W).norm() < kThere) watch_->since = now;
  if (!watch_->since) {
    search_for_watch(world, here_W);
    return;
  }
  strip_.clear();
  if (!closure_ || now - *watch_->since < kWatchTime) return;
  watch_.reset();
  closure_.reset();
}

void StripRoute::search_for_watch(const PlanWorld& world, const Vec2& here_W) {
  aim_ = Aim::Watch;
  planner_.start(world, here_W, watch_->from_W, plan_options());
}

/// Lays the strip along the plan if there is no strip, or if the new one is clearly better.
void StripRoute::take_plan(const PlanWorld& world, const Vec2& here_W) {
  planner_.path(world, path_);
  if (aim_ == Aim::Goal && !path_.unsure) failures_ = 0;
  line_W_.clear();
  for (std::size_t i = 0; i < path_.local; ++i) line_W_.push_back(path_.points_W[i]);
  straighten(world, settings_.strip.rest_distance, step_cost().least, line_W_);
  candidate_.lay(line_W_);
  candidate_.follow(here_W);
  candidate_.relax(world.map, settings_.strip, kSweepsNew);
  candidate_.centre(world.map, settings_.strip);
  if (candidate_.broken_at(world.map, settings_.strip) >= 0) {
    // Relaxing moved it off its way: take the plan as it is.
    candidate_.lay(line_W_);
    candidate_.follow(here_W);
  }
  const bool taken = aim_ == Aim::Goal && planner_.goal_taken();
  const bool was_taken = std::exchange(goal_taken_, taken);
  if (!is_better(world.map, was_taken)) return;
  std::swap(strip_, candidate_);
  broken_at_ = -1;
}

/// True if the candidate should replace the strip.
bool StripRoute::is_better(const LocalMap& map, bool was_taken) const {
  if (strip_.empty() || broken_at_ >= 0) return true;
  // A strip that ends beside the goal, since an obstacle stands there, may well cost less than one
  // that ends nearer.
  if ((goal_taken_ || was_taken) && left(candidate_) < left(strip_) - kNearerTaken) return true;
  if (left(candidate_) < kAtGoal && left(strip_) >= kAtGoal) return true;
  const std::optional<double> rest = planner_.cost_from(strip_.end_W());
  if (!rest || is_extended()) return true;
  const StepCost step = step_cost();
  return candidate_.cost(map, step) + path_.beyond < kOtherShare * (strip_.cost(map, step) + *rest);
}

/// True if the new path goes on where the strip ends.
bool StripRoute::is_extended() const {
  const std::optional<double> rest = planner_.cost_from(strip_.end_W());
  if (!rest || path_.beyond > *rest - kNearer) return false;
  for (std::size_t i = 0; i < path_.local; ++i) {
    if ((path_.points_W[i] - strip_.end_W()).squaredNorm() < kSameWay * kSameWay) return true;
  }
  return false;
}

}  // namespace algo
