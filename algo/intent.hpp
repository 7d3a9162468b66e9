// algo/intent.hpp: what people have requested of a robot; the one place that interprets requests.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "algo/obstacle.hpp"
#include "algo/parameters.hpp"
#include "algo/request.hpp"

namespace algo {

constexpr std::size_t kMostGoalsAhead = 100;

/// The sum of all requests so far. The control thread owns the original. A session and a page keep
/// copies, to which they apply the same requests once accepted.
struct Intent {
  std::optional<SetGoal> goal{};
  std::vector<SetGoal> goals_ahead{};  // after `goal`, in order
  bool stop = false;
  Joystick stick{};
  Parameters parameters{};
  std::vector<Obstacle> obstacles{};

  /// Applies `request`. Returns true if it replaced the goals: state about the way to the old ones
  /// is then void. Does not allocate for goals once there is room for kMostGoalsAhead.
  bool apply(const Request& request);
  /// Replaces the reached goal by the first of goals_ahead, which must not be empty.
  void go_on();

 private:
  bool set_goal(const std::optional<SetGoal>& to);
};

/// True if `request` changes obstacles, which needs a robot with Editing.
bool is_edit(const Request& request);

}  // namespace algo
