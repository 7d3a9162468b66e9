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
constexpr std::size_t kMostGoals = kMostGoalsAhead + 1;

/// The sum of all requests so far. The control thread owns the original. A session and a page keep
/// copies, to which they apply the same requests once accepted.
struct Intent {
  std::optional<SetGoal> goal{};
  std::vector<SetGoal> goals_behind{};  // reached, in order; the newest kMostGoalsAhead
  std::vector<SetGoal> goals_ahead{};   // after `goal`, in order
  bool loop = false;                    // after the last goal, go on to the first
  bool stop = false;
  Joystick stick{};
  std::optional<SetHandGoal> hand_goal{};  // excludes `goal`
  std::optional<SetGoal> carry_goal{};     // the same, with the arm as it is
  std::optional<SetJoints> joint_goal{};
  std::uint32_t arm_goals = 0;  // counts those of the arm: the same may be set again
  Parameters parameters{};
  std::vector<Obstacle> obstacles{};

  /// Applies `request`. Returns true if it replaced the goals: state about the way to the old ones
  /// is then void. Does not allocate for goals once there is room for kMostGoalsAhead.
  bool apply(const Request& request);
  /// Whether another goal follows the present one.
  bool has_next() const { return !goals_ahead.empty() || (loop && !goals_behind.empty()); }
  /// Replaces the reached goal by the next one, which there must be.
  void go_on();
  /// All goals in the order in which they were set.
  std::vector<SetGoal> route() const;
  /// Makes room for the goals, so that they need no memory while the robot drives.
  void reserve();

 private:
  bool set_goal(const std::optional<SetGoal>& to);
  bool set_goals(const SetGoals& to);
};

/// True if `request` changes obstacles, which needs a robot with Editing.
bool is_edit(const Request& request);

}  // namespace algo
