// server/run/pose_json.cpp: one reader and one writer each.
#include "server/run/pose_json.hpp"

#include <cmath>
#include <numbers>
#include <string_view>

#include <fmt/format.h>

#include "algo/intent.hpp"

namespace server {
namespace {

using nlohmann::json;

double angle_or(const JsonReader& in, std::string_view key, double fallback) {
  return algo::wrap_angle(in.number_or(key, fallback, {-1e6, 1e6}));
}

}  // namespace

algo::Vec2 point_from_json(const json& value, const std::string& path) {
  if (!value.is_array() || value.size() != 2) {
    throw DocumentError(path, "must be a point [x, y] in metres");
  }
  return {finite_number(value[0], path + "/0", kCoordinate),
          finite_number(value[1], path + "/1", kCoordinate)};
}

algo::Pose2 pose_from_json(const JsonReader& in, double heading) {
  return {
      in.number("x", kCoordinate), in.number("y", kCoordinate), angle_or(in, "heading", heading)};
}

algo::Pose2 mount_from_json(const JsonReader& in) {
  constexpr NumberRange kReach{-10, 10};                 // [m] as far as a mast or boom may reach
  constexpr double kTurn = 2 * std::numbers::pi + 0.01;  // [rad] rounded up
  const double heading = in.number_or("heading", 0);
  if (std::abs(heading) > kTurn) {
    in.fail("heading", fmt::format("is {:g}, more than a turn: angles are in radians", heading));
  }
  return {in.number("x", kReach), in.number("y", kReach), algo::wrap_angle(heading)};
}

algo::SetGoal goal_from_json(const JsonReader& in) {
  algo::SetGoal goal;
  goal.position_W = {in.number("x", kCoordinate), in.number("y", kCoordinate)};
  if (in.has("heading")) goal.heading = angle_or(in, "heading", 0);
  return goal;
}

algo::SetGoal strict_goal(const JsonReader& in) {
  in.only({"x", "y", "heading"});
  return goal_from_json(in);
}

std::vector<algo::SetGoal> waypoints_from_json(const JsonReader& in) {
  std::vector<algo::SetGoal> waypoints;
  if (!in.has("waypoints")) return waypoints;
  in.each("waypoints", algo::kMostGoalsAhead, [&](const json& value, const std::string& at) {
    if (!in.has("goal")) in.fail("waypoints", "lead nowhere: there is no goal");
    waypoints.push_back(strict_goal({value, at}));
  });
  return waypoints;
}

algo::SetGoals goals_from_json(const JsonReader& in) {
  algo::SetGoals list;
  in.each("goals", algo::kMostGoals, [&](const json& value, const std::string& at) {
    list.goals.push_back(strict_goal({value, at}));
  });
  const std::size_t last = list.goals.empty() ? 0 : list.goals.size() - 1;
  list.next = static_cast<std::uint32_t>(in.whole_or("next", 0, last));
  list.loop = in.flag_or("loop", false);
  return list;
}

algo::Pose2 start_from_json(const JsonReader& in, const std::optional<algo::SetGoal>& goal) {
  algo::Pose2 start;
  bool heading_given = false;
  if (in.has("start")) {
    const JsonReader given = in.object("start");
    given.only({"x", "y", "heading"});
    start = pose_from_json(given, 0);
    heading_given = given.has("heading");
  }
  if (goal && !heading_given) {
    const algo::Vec2 to_goal = goal->position_W - start.position();
    start.heading = std::atan2(to_goal.y(), to_goal.x());
  }
  return start;
}

json to_json(const algo::Pose2& pose) {
  return {{"x", pose.x}, {"y", pose.y}, {"heading", pose.heading}};
}

json to_json(const algo::SetGoal& goal) {
  json out = {{"x", goal.position_W.x()}, {"y", goal.position_W.y()}};
  out["heading"] = goal.heading ? json(*goal.heading) : json(nullptr);
  return out;
}

}  // namespace server
