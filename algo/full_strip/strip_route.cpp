// algo/full_strip/strip_route.cpp: plans, compares, and fits the strip.
#include "algo/full_strip/strip_route.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "algo/full_strip/progress_watch.hpp"

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
constexpr double kTryTight = 4.0;     // [s] for which it tries for a near goal without room
constexpr double kLastLeg = 2 * LocalMap::kReach;  // [m] to the goal
constexpr double kGives = 0.08;  // [m] by which the strip stays inside its rest distance

}  // namespace

void StripRoute::reset() {
  set_goal({0, 0}, 0);
  goal_W_.reset();
  path_W_.clear();
}

void StripRoute::set_goal(const Vec2& goal_W, double now) {
  goal_W_ = goal_W;
  strip_.clear();
  planner_.reset();
  level_ = 0;
  no_way_ = false;
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
                        const LocalMap& map,
                        const Vec2& here_W,
                        double now) {
  settings_ = settings;
  ease_last_leg(map, here_W);
  stretch(map, here_W, now);
  plan(map, here_W, now);
}

double StripRoute::least_clearance() const {
  return settings_.half_width + kRoom[level_];
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
  const double room = std::max(map.distance(*goal_W_) + kGives, least_clearance());
  settings_.strip.rest_distance = std::min(settings_.strip.rest_distance, room);
}

/// The reactive layer: fits the strip to the robot and the map.
void StripRoute::stretch(const LocalMap& map, const Vec2& here_W, double now) {
  if (strip_.empty()) return;
  strip_.follow(here_W);
  strip_.relax(map, settings_.strip, kSweeps);
  StripSettings narrow = settings_.strip;
  narrow.least_clearance = settings_.half_width + kRoom.back() - settings_.break_room;
  broken_at_ = strip_.broken_at(map, narrow);
  if (broken_at_ >= 0) next_plan_ = std::min(next_plan_, now);
}

/// The deliberative layer: one portion of a search each tick, a new search every plan_period.
void StripRoute::plan(const LocalMap& map, const Vec2& here_W, double now) {
  if (planner_.state() != Planner::State::Searching && now >= next_plan_) {
    start_search(map, here_W, now);
  }
  if (planner_.state() != Planner::State::Searching) return;
  const bool urgent = strip_.empty() || broken_at_ >= 0;
  switch (planner_.search(map, urgent ? kExpansionsNow : kExpansions)) {
    case Planner::State::Found:
      take_plan(map, here_W);
      return;
    case Planner::State::NoWay:
      if (level_ + 1 < kRoom.size()) {
        ++level_;
        next_plan_ = now;
      } else {
        no_way_ = true;
        level_ = 0;
      }
      return;
    default:
      return;
  }
}

void StripRoute::start_search(const LocalMap& map, const Vec2& here_W, double now) {
  // Low clearance at the goal does not mean that an obstacle stands on it.
  while (level_ + 1 < kRoom.size() && map.distance(*goal_W_) < least_clearance() &&
         map.seen().seen(*goal_W_)) {
    ++level_;
  }
  const double patience = ProgressWatch::time_for(kTryTight, settings_.max_v);
  const bool try_tight = !tight_since_ || now - *tight_since_ < patience;
  planner_.start(map, here_W, *goal_W_, least_clearance(), try_tight);
  if (planner_.goal_tight() && !tight_since_) tight_since_ = now;
  next_plan_ = now + settings_.plan_period;
}

/// Makes the plan the strip if there is none, or if it is clearly better than the present one.
void StripRoute::take_plan(const LocalMap& map, const Vec2& here_W) {
  no_way_ = false;
  planner_.path(path_W_);
  straighten(map, settings_.strip.rest_distance, path_W_);
  candidate_.lay(path_W_);
  candidate_.follow(here_W);
  StripSettings settings = settings_.strip;
  settings.least_clearance = least_clearance() - settings_.break_room;
  candidate_.relax(map, settings, kSweepsNew);
  if (candidate_.broken_at(map, settings) >= 0) {
    // Relaxing moved it off its way: take the plan as it is.
    candidate_.lay(path_W_);
    candidate_.follow(here_W);
  }
  // A strip may end short of the goal, if the goal lay beyond the map or an obstacle stands on it.
  // It may well cost less than one that ends nearer.
  const bool was_taken = std::exchange(goal_taken_, planner_.goal_taken());
  if (is_better(map, goal_taken_ || was_taken ? kNearerTaken : kNearer)) {
    std::swap(strip_, candidate_);
    broken_at_ = -1;
  }
  level_ = 0;  // the next search begins with the widest again
}

/// True if the candidate should replace the strip. `nearer` [m]: see kNearer.
bool StripRoute::is_better(const LocalMap& map, double nearer) const {
  return strip_.empty() || broken_at_ >= 0 || left(candidate_) < left(strip_) - nearer ||
         (left(candidate_) < kAtGoal && left(strip_) >= kAtGoal) ||
         candidate_.cost(map) < kOtherShare * strip_.cost(map);
}

}  // namespace algo
