// server/run/request_json.cpp: one branch per kind of request.
#include "server/run/request_json.hpp"

#include <string>
#include <variant>

#include <fmt/format.h>

#include "algo/pipeline/parameter_table.hpp"
#include "server/run/arm_json.hpp"
#include "server/run/json_reader.hpp"
#include "server/run/obstacle_json.hpp"
#include "server/run/pose_json.hpp"

namespace server {

algo::Request request_from_json(const nlohmann::json& value) {
  const JsonReader in(value, "");
  const std::string type = in.text("type");
  if (type == "set_goal") {
    in.only({"type", "x", "y", "heading"});
    return goal_from_json(in);
  }
  if (type == "add_goal") {
    in.only({"type", "x", "y", "heading"});
    return algo::AddGoal{goal_from_json(in)};
  }
  if (type == "set_goals") {
    in.only({"type", "goals", "next", "loop"});
    return goals_from_json(in);
  }
  if (type == "clear_goal") {
    in.only({"type"});
    return algo::ClearGoal{};
  }
  if (type == "add_obstacle") {
    in.only({"type", "obstacle"});
    return algo::AddObstacle{obstacle_from_json(in.object("obstacle").raw(), "obstacle")};
  }
  if (type == "change_obstacle") {
    in.only({"type", "obstacle"});
    algo::ChangeObstacle change{obstacle_from_json(in.object("obstacle").raw(), "obstacle")};
    if (change.obstacle.id == 0) in.fail("obstacle", "must have the id of the one to change");
    return change;
  }
  if (type == "move_obstacle") {
    in.only({"type", "id", "x", "y", "heading"});
    return algo::MoveObstacle{static_cast<std::uint32_t>(in.whole("id", kMaxStandingId)),
                              pose_from_json(in, 0)};
  }
  if (type == "remove_obstacle") {
    in.only({"type", "id"});
    return algo::RemoveObstacle{static_cast<std::uint32_t>(in.whole("id", kMaxStandingId))};
  }
  if (type == "joystick") {
    in.only({"type", "forward", "turn", "mode", "round_trip"});
    const std::string mode = in.text_or("mode", "guarded");
    const auto known = algo::stick_mode(mode);
    if (!known)
      in.fail("mode", fmt::format("'{}' is unknown; known are {}", mode, algo::kStickModeList));
    const double round_trip = in.has("round_trip") ? in.number("round_trip", {0, 60}) : 0;
    return algo::Joystick{
        in.number("forward", {-1, 1}), in.number("turn", {-1, 1}), *known, round_trip};
  }
  if (type == "stop") {
    in.only({"type", "engaged"});
    return algo::Stop{in.flag_or("engaged", true)};
  }
  if (type == "set_parameter") {
    in.only({"type", "name", "value"});
    const std::string name = in.text("name");
    const algo::ParameterInfo* const parameter = algo::find_parameter(name);
    if (parameter == nullptr) in.fail("name", fmt::format("there is no parameter '{}'", name));
    return algo::SetParameter{parameter, in.number("value")};
  }
  if (type == "set_joints") {
    in.only({"type", "position"});
    return algo::SetJoints{joint_values(in, "position", {-10, 10})};
  }
  if (type == "set_hand_goal") {
    in.only(kHandGoalFields);
    return hand_goal_from_json(in);
  }
  if (type == "carry") {
    in.only({"type", "x", "y", "heading"});
    return algo::Carry{goal_from_json(in)};
  }
  if (type == "set_initial_pose") {
    in.only({"type", "x", "y", "heading"});
    const bool anywhere = !in.has("x") && !in.has("y") && !in.has("heading");
    if (anywhere) return algo::SetInitialPose{};
    in.number("heading");  // a default would be a guess
    return algo::SetInitialPose{pose_from_json(in, 0)};
  }
  in.fail("type",
          fmt::format("'{}' is unknown; known are set_goal, add_goal, set_goals, clear_goal, "
                      "add_obstacle, change_obstacle, move_obstacle, remove_obstacle, joystick, "
                      "stop, set_parameter, set_joints, set_hand_goal, carry, set_initial_pose",
                      type));
}

bool is_stop(const algo::Request& request) {
  const auto* stop = std::get_if<algo::Stop>(&request);
  return stop != nullptr && stop->engaged;
}

}  // namespace server
