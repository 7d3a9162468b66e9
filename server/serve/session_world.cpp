// server/serve/session_world.cpp: the world of a session as people have changed it.
#include <utility>

#include "server/serve/session.hpp"
#include "sim/obstacle_set.hpp"

namespace server {
namespace {

/// True if the goals of base and arm are those of `scenario`.
bool has_goals_of(const SessionState& state, const sim::Scenario& scenario) {
  if (state.hand_goal != scenario.hand_goal) return false;
  if (scenario.carry) return state.carry_goal == scenario.goal && state.route == algo::SetGoals{};
  return !state.carry_goal && state.route == route_of(scenario);
}

}  // namespace

sim::Scenario Session::as_scenario() const {
  sim::Scenario out = state_.spec.scenario;
  out.waypoints = state_.route.goals;
  out.loop = state_.route.loop;
  out.goal.reset();
  if (!out.waypoints.empty()) {
    out.goal = out.waypoints.back();
    out.waypoints.pop_back();
  }
  out.hand_goal = state_.hand_goal;
  out.carry = state_.carry_goal.has_value();
  if (out.carry) out.goal = state_.carry_goal;
  out.obstacles = state_.asked.obstacles;
  out.parameters = state_.asked.parameters;
  return out;
}

RunSpec Session::again() const {
  RunSpec spec = state_.spec;
  if (spec.hardware || !spec.scenario.log.empty()) return spec;
  spec.scenario = as_scenario();
  spec.parameters = spec.scenario.parameters;
  return spec;
}

std::optional<std::string> Session::set_start(const algo::Pose2& start_W) {
  if (!state_.editable) return "This world has no start that could be moved.";
  sim::ObstacleSet standing;
  for (const algo::Obstacle& obstacle : state_.asked.obstacles) {
    if (!obstacle.path) standing.add(obstacle);
  }
  const algo::Hull hull{state_.robot.radius, state_.robot.half_length, state_.robot.half_width};
  if (standing.clearance(hull, start_W) < 0) return "There the robot would overlap an obstacle.";
  state_.spec.scenario.start = start_W;
  note_edits();
  changed();
  return std::nullopt;
}

void Session::saved(const sim::Scenario& scenario) {
  saved_ = scenario;
  state_.spec.scenario.name = scenario.name;
  state_.spec.scenario.title = scenario.title;
  note_edits();
  changed();
}

void Session::note_goals() {
  state_.route = {state_.asked.route(), 0, state_.asked.loop};
  state_.hand_goal = state_.asked.hand_goal;
  state_.carry_goal = state_.asked.carry_goal;
}

void Session::note_edits() {
  state_.edited = state_.spec.scenario.start != saved_.start || !has_goals_of(state_, saved_) ||
                  state_.asked.obstacles != saved_.obstacles;
}

}  // namespace server
