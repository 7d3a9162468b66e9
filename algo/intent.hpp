// algo/intent.hpp: what people want of a robot, and the one place that says what a request means.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "algo/obstacle.hpp"
#include "algo/parameters.hpp"
#include "algo/request.hpp"

namespace algo {

constexpr std::size_t kMostGoalsAhead = 100;

/// All requests so far added up. The control thread owns the true one; a session and a page keep
/// copies to which the same requests are applied once they were accepted.
struct Intent {
  std::optional<SetGoal> goal{};
  std::vector<SetGoal> goals_ahead{};  // after that one, in order
  bool stop = false;
  Joystick stick{};
  Parameters parameters{};
  std::vector<Obstacle> obstacles{};

  /// True when the goals began anew: what is known of the way to the old ones is void. Allocates
  /// nothing for goals once there is room for kMostGoalsAhead.
  bool apply(const Request& request);
  /// The goal is reached: the first of those ahead is the goal. There must be one.
  void go_on();

 private:
  bool set_goal(const std::optional<SetGoal>& to);
};

/// True for what a robot that has Editing carries out: a change of its obstacles.
bool is_edit(const Request& request);

}  // namespace algo
