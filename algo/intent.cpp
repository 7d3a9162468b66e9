// algo/intent.cpp: the effect of each request.
#include "algo/intent.hpp"

#include <algorithm>
#include <array>
#include <variant>

namespace algo {
namespace {

template <class... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

constexpr std::array<std::string_view, 4> kStickModes{"guarded", "wall", "raw", "elastic"};

}  // namespace

bool Intent::set_goal(const std::optional<SetGoal>& to) {
  goal = to;
  hand_goal.reset();
  carry_goal.reset();
  goals_behind.clear();
  goals_ahead.clear();
  loop = false;
  return true;
}

bool Intent::set_goals(const SetGoals& to) {
  const std::optional<SetGoal> before = goal;
  set_goal(std::nullopt);
  loop = to.loop;
  if (to.goals.empty()) return true;
  const auto at = to.goals.begin() + to.next;
  goals_behind.assign(to.goals.begin(), at);
  goal = *at;
  goals_ahead.assign(at + 1, to.goals.end());
  return goal != before;
}

void Intent::go_on() {
  if (goals_behind.size() >= kMostGoalsAhead) goals_behind.erase(goals_behind.begin());
  goals_behind.push_back(*goal);
  if (goals_ahead.empty()) goals_ahead.swap(goals_behind);  // begins the loop again
  goal = goals_ahead.front();
  goals_ahead.erase(goals_ahead.begin());
}

std::vector<SetGoal> Intent::route() const {
  std::vector<SetGoal> all = goals_behind;
  if (goal) all.push_back(*goal);
  all.insert(all.end(), goals_ahead.begin(), goals_ahead.end());
  return all;
}

void Intent::reserve() {
  goals_behind.reserve(kMostGoalsAhead + 1);
  goals_ahead.reserve(kMostGoalsAhead + 1);
}

bool Intent::apply(const Request& request) {
  return std::visit(
      Overloaded{[&](const SetGoal& to) { return set_goal(to); },
                 [&](const AddGoal& add) {
                   if (!goal) return set_goal(add.goal);
                   goals_ahead.push_back(add.goal);
                   return false;
                 },
                 [&](const SetGoals& to) { return set_goals(to); },
                 [&](const ClearGoal&) {
                   joint_goal.reset();
                   return set_goal(std::nullopt);
                 },
                 [&](const Joystick& pushed) {
                   stick = pushed;
                   // When a driver goes silent the robot must stand still, not drive off to an old
                   // goal.
                   return !pushed.centred() && set_goal(std::nullopt);
                 },
                 [&](const Stop& wanted) {
                   stop = wanted.engaged;
                   return false;
                 },
                 [&](const SetParameter& set) {
                   parameters.set(*set.parameter, set.value);
                   return false;
                 },
                 [&](const AddObstacle& add) {
                   obstacles.push_back(add.obstacle);
                   return false;
                 },
                 [&](const ChangeObstacle& change) {
                   const auto it = std::ranges::find(obstacles, change.obstacle.id, &Obstacle::id);
                   if (it != obstacles.end()) *it = change.obstacle;
                   return false;
                 },
                 [&](const MoveObstacle& move) {
                   const auto it = std::ranges::find(obstacles, move.id, &Obstacle::id);
                   if (it != obstacles.end()) it->pose_W = move.pose_W;
                   return false;
                 },
                 [&](const RemoveObstacle& remove) {
                   std::erase_if(obstacles, [&](const auto& o) { return o.id == remove.id; });
                   return false;
                 },
                 [&](const SetJoints& to) {
                   hand_goal.reset();
                   carry_goal.reset();
                   joint_goal = to;
                   ++arm_goals;
                   return false;
                 },
                 [&](const SetHandGoal& to) {
                   set_goal(std::nullopt);
                   joint_goal.reset();
                   hand_goal = to;
                   ++arm_goals;
                   return true;
                 },
                 [&](const Carry& to) {
                   set_goal(std::nullopt);
                   joint_goal.reset();
                   carry_goal = to.goal;
                   ++arm_goals;
                   return true;
                 },
                 [](const TakePlan&) { return false; },
                 [](const SetInitialPose&) { return false; }},
      request);
}

std::string_view name(StickMode mode) {
  return kStickModes.at(static_cast<std::size_t>(mode));
}

std::optional<StickMode> stick_mode(std::string_view name) {
  const auto* const it = std::ranges::find(kStickModes, name);
  if (it == kStickModes.end()) return std::nullopt;
  return static_cast<StickMode>(it - kStickModes.begin());
}

bool is_edit(const Request& request) {
  return std::holds_alternative<AddObstacle>(request) ||
         std::holds_alternative<ChangeObstacle>(request) ||
         std::holds_alternative<MoveObstacle>(request) ||
         std::holds_alternative<RemoveObstacle>(request);
}

}  // namespace algo
