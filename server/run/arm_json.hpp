// server/run/arm_json.hpp: the arm in a robot's file, and in the spec that a run's document keeps.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include <nlohmann/json.hpp>

#include "algo/arm_spec.hpp"
#include "algo/request.hpp"
#include "server/run/json_reader.hpp"
#include "sim/arm_model.hpp"

namespace server {

/// The field "arm" of a robot's file; none if it has none. Throws DocumentError.
std::optional<sim::ArmModel> arm_from_json(const JsonReader& robot);
nlohmann::json to_json(const sim::ArmModel& arm);

/// The field "arm" of a spec, in radians: its numbers are exact.
std::optional<algo::ArmSpec> arm_spec_from_json(const JsonReader& spec);
nlohmann::json spec_json(const algo::ArmSpec& arm);

/// {"x","y","z","qw"?,"qx"?,"qy"?,"qz"?,"arm_angle"?,"base_stays"?,"path"?,"then"?}; without
/// an attitude the hand points along the world's z axis. Throws DocumentError.
algo::SetHandGoal hand_goal_from_json(const JsonReader& in);
nlohmann::json to_json(const algo::SetHandGoal& goal);
/// "x,y,z" or "x,y,z,qx,qy,qz,qw", as on the command line. Throws DocumentError naming `field`.
algo::SetHandGoal hand_goal_from_text(const std::string& text, const std::string& field);
/// Seven numbers [rad] with commas between them.
algo::JointValues joints_from_text(const std::string& text, const std::string& field);
inline constexpr std::array<std::string_view, 12> kHandGoalFields{
    "type", "x", "y", "z", "qw", "qx", "qy", "qz", "arm_angle", "base_stays", "path", "then"};

/// Seven numbers at `key`, each within `range`. Throws DocumentError.
algo::JointValues joint_values(const JsonReader& in,
                               const char* key,
                               NumberRange range = {},
                               double unit = 1);

}  // namespace server
