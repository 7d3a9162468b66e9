// server/run/pose_json.hpp: points, poses and goals as JSON: metres and radians.
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

/// [x, y]. All of them throw DocumentError naming the field.
algo::Vec2 point_from_json(const nlohmann::json& value, const std::string& path);

/// {"x","y","heading"?}; `heading` [rad] where none is given.
algo::Pose2 pose_from_json(const JsonReader& in, double heading);
nlohmann::json to_json(const algo::Pose2& pose);

/// {"x","y","heading"?}: without a heading any will do.
algo::SetGoal goal_from_json(const JsonReader& in);

/// The same, and nothing else in it.
algo::SetGoal strict_goal(const JsonReader& in);
/// The field "waypoints" of `in`, which lead to its goal; empty without one.
std::vector<algo::SetGoal> waypoints_from_json(const JsonReader& in);
/// The field "start" of `in`, the origin without one. As in the paper, a start without a heading
/// faces the `goal`.
algo::Pose2 start_from_json(const JsonReader& in, const std::optional<algo::SetGoal>& goal);
nlohmann::json to_json(const algo::SetGoal& goal);

}  // namespace server
