// algo/pipeline/sequencing.cpp: the goal's state machine and the stuck rule.
#include "algo/pipeline/sequencing.hpp"

#include <algorithm>
#include <cmath>

#include "algo/driving.hpp"

namespace algo {
namespace {

constexpr double kStuckRadius = 0.060;    // [m]
constexpr double kStuckWindow = 20.0;     // [s] at least
constexpr double kStuckDistance = 0.800;  // [m] nominal travel within the window

bool at_goal(const SetGoal& goal, const Pose2& pose_W, double reach) {
  const double distance = (goal.position_W - pose_W.position()).norm();
  if (!(distance < reach)) return false;
  if (!goal.heading) return true;
  return std::abs(wrap_angle(*goal.heading - pose_W.heading)) < kHeadingReach;
}

}  // namespace

double StuckDetector::window(double v_max) {
  return std::max(kStuckWindow, kStuckDistance / v_max);
}

void StuckDetector::reset(double period) {
  period_ = period;
  const double longest = window(kMaxSpeed.min);
  ring_.assign(static_cast<std::size_t>(longest / period) + 2, Vec2{0, 0});
  next_ = 0;
  count_ = 0;
}

bool StuckDetector::update(const Vec2& position_W, double v_max) {
  const auto wanted = static_cast<std::size_t>(std::lround(window(v_max) / period_));
  const std::size_t needed = std::min(wanted, ring_.size());
  // Oldest first: for a moving robot the first comparison fails.
  bool stuck = count_ >= needed;
  for (std::size_t back = std::min(needed, count_); stuck && back > 0; --back) {
    const Vec2& past = ring_[(next_ + ring_.size() - back) % ring_.size()];
    stuck = (past - position_W).norm() <= kStuckRadius;
  }
  ring_[next_] = position_W;
  next_ = (next_ + 1) % ring_.size();
  count_ = std::min(count_ + 1, ring_.size());
  return stuck;
}

void Sequencer::reset(double period) {
  mission_ = Mission::Idle;
  stuck_.reset(period);
}

void Sequencer::begin(const Intent& intent) {
  mission_ = intent.goal ? Mission::Driving : Mission::Idle;
  stuck_.restart();
}

void Sequencer::go_on(Intent& intent) {
  intent.go_on();
  mission_ = Mission::Driving;
  stuck_.restart();
}

Mission Sequencer::update(const Pose2& pose_W, Intent& intent) {
  if (mission_ == Mission::Arrived && intent.has_next()) go_on(intent);
  if (!intent.goal || mission_ == Mission::Arrived) return mission_;
  // A loop of goals within reach of each other has no end.
  std::size_t left = intent.goals_behind.size() + intent.goals_ahead.size();
  while (at_goal(*intent.goal, pose_W, intent.parameters[algo::kGoalReach])) {
    if (!intent.has_next() || left-- == 0) return mission_ = Mission::Arrived;
    go_on(intent);
  }

  const Vec2 position_W = pose_W.position();
  if (stuck_.update(position_W, intent.parameters[algo::kMaxSpeed])) {
    if (mission_ != Mission::Stuck) stuck_at_W_ = position_W;
    mission_ = Mission::Stuck;
  } else if (mission_ == Mission::Stuck && (position_W - stuck_at_W_).norm() > kStuckRadius) {
    mission_ = Mission::Driving;
  }
  return mission_;
}

}  // namespace algo
