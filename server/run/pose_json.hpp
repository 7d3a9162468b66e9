// server/run/pose_json.hpp: points, poses and goals as JSON, in metres and radians.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "algo/request.hpp"
#include "algo/types.hpp"
#include "server/run/json_reader.hpp"

namespace server {

constexpr NumberRange kCoordinate{-1e5, 1e5};  // [m]

/// [x, y]. Every reader here throws DocumentError naming the field.
algo::Vec2 point_from_json(const nlohmann::json& value, const std::string& path);

/// {"x","y","heading"?}; `heading` [rad] is the default.
algo::Pose2 pose_from_json(const JsonReader& in, double heading);
nlohmann::json to_json(const algo::Pose2& pose);

/// The same of a sensor on a robot: within 10 m of its middle, the heading within a full turn.
algo::Pose2 mount_from_json(const JsonReader& in);

/// {"x","y","heading"?}; without a heading, any heading will do.
algo::SetGoal goal_from_json(const JsonReader& in);

/// As goal_from_json(), but refuses any other field.
algo::SetGoal strict_goal(const JsonReader& in);
/// The field "waypoints" of `in`, the way to its goal; empty without the field.
std::vector<algo::SetGoal> waypoints_from_json(const JsonReader& in);
/// {"goals":[...],"next"?,"loop"?}: a whole list.
algo::SetGoals goals_from_json(const JsonReader& in);
/// The field "start" of `in`; the origin without the field. As in the paper, a start without a
/// heading faces the `goal`.
algo::Pose2 start_from_json(const JsonReader& in, const std::optional<algo::SetGoal>& goal);
nlohmann::json to_json(const algo::SetGoal& goal);

}  // namespace server
