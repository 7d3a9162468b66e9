// server/run/arm_json.cpp: one reader and one writer for the file and for the spec.
#include "server/run/arm_json.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "algo/units.hpp"
#include "server/run/json_fields.hpp"
#include "server/run/pose_json.hpp"

namespace server {
namespace {

using algo::units::kRadiansPerDegree;
using nlohmann::json;
using Arm = sim::ArmModel;
using Spec = algo::ArmSpec;

constexpr NumberRange kLinkLength{0.05, 2};  // [m]
constexpr NumberRange kLinkRadius{0.005, 0.5};
constexpr NumberRange kShoulder{-2, 2};  // [m] in R
constexpr NumberRange kLimitDegrees{1, 180};
constexpr NumberRange kRateDegrees{1, 1000};
constexpr NumberRange kRestDegrees{-180, 180};
constexpr NumberRange kLinkMass{0.01, 100};  // [kg]
constexpr NumberRange kTorque{0.01, 1e4};    // [N m]

constexpr Field<Arm> kArm[] = {
    {"mount"},
    {"shoulder_offset"},
    required("upper_arm", static_cast<double Arm::*>(&Arm::upper_arm), kLinkLength),
    {"elbow_offset", static_cast<double Arm::*>(&Arm::elbow_offset), {-0.5, 0.5}},
    required("forearm", static_cast<double Arm::*>(&Arm::forearm), kLinkLength),
    required("hand", static_cast<double Arm::*>(&Arm::hand), kLinkLength),
    {"link_radius", static_cast<double Arm::*>(&Arm::link_radius), kLinkRadius},
    {"mast_radius", static_cast<double Arm::*>(&Arm::mast_radius), kLinkRadius},
    {"limits_deg"},
    {"rates_deg"},
    {"rest_deg"},
    {"masses"},
    {"torques"},
    {"payload", &Arm::payload, {0, 100}},
    {"step_rate", &Arm::step_rate, {240, 2000}},
};

constexpr Field<Spec> kArmSpec[] = {
    {"shoulder"},
    required("heading", &Spec::heading),
    required("upper_arm", &Spec::upper_arm),
    required("elbow_offset", &Spec::elbow_offset),
    required("forearm", &Spec::forearm),
    required("hand", &Spec::hand),
    required("link_radius", &Spec::link_radius),
    required("mast_radius", &Spec::mast_radius),
    required("base_height", &Spec::base_height),
    required("scan_height", &Spec::scan_height),
    {"limits"},
    {"rates"},
    {"rest"},
};

void read_values(const JsonReader& in,
                 const char* key,
                 NumberRange range,
                 double unit,
                 algo::JointValues& values) {
  if (in.has(key)) values = joint_values(in, key, range, unit);
}

algo::Vec3 place_from_json(const JsonReader& in) {
  return {in.number("x", kCoordinate), in.number("y", kCoordinate), in.number("z", kCoordinate)};
}

algo::Vec3 path_point_from_json(const JsonReader& in) {
  in.only({"x", "y", "z"});
  return place_from_json(in);
}

json in_degrees(const algo::JointValues& radians) {
  json out = json::array();
  for (const double value : radians) {
    out.push_back(std::round(value / kRadiansPerDegree * 1e9) / 1e9);
  }
  return out;
}

/// `text` as a list of numbers with commas between them.
json list_of(const std::string& text, const std::string& field) {
  json list = json::parse('[' + text + ']', nullptr, false);
  const auto is_number = [](const json& each) { return each.is_number(); };
  if (list.is_discarded() || !std::ranges::all_of(list, is_number)) {
    throw DocumentError(field, fmt::format("'{}' is no list of numbers such as 1,0.5,2", text));
  }
  return list;
}

}  // namespace

algo::JointValues joint_values(const JsonReader& in,
                               const char* key,
                               NumberRange range,
                               double unit) {
  const json& list = in.array(key, algo::kArmJoints);
  if (list.size() != algo::kArmJoints) {
    in.fail(key, fmt::format("must be {} numbers, one for each joint", algo::kArmJoints));
  }
  algo::JointValues values{};
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k] = unit * finite_number(list[k], fmt::format("{}/{}", in.at(key), k), range);
  }
  return values;
}

algo::SetHandGoal hand_goal_from_json(const JsonReader& in) {
  constexpr NumberRange kUnit{-1, 1};
  constexpr double kUnitError = 1e-3;  // of the length; a person may round
  algo::SetHandGoal goal;
  goal.position_W = place_from_json(in);
  algo::Quaternion& a = goal.attitude_W;
  const bool given = in.has("qw") || in.has("qx") || in.has("qy") || in.has("qz");
  a = {in.number_or("qw", given ? 0 : 1, kUnit),
       in.number_or("qx", 0, kUnit),
       in.number_or("qy", 0, kUnit),
       in.number_or("qz", 0, kUnit)};
  const double length = std::sqrt(a.w * a.w + a.x * a.x + a.y * a.y + a.z * a.z);
  if (std::abs(length - 1) > kUnitError) {
    in.fail("qw", fmt::format("and qx, qy, qz must have length 1, not {:.3f}", length));
  }
  if (in.has("arm_angle")) goal.arm_angle = algo::wrap_angle(in.number("arm_angle", {-1e3, 1e3}));
  goal.base_stays = in.flag_or("base_stays", false);
  if (in.has("path")) {
    in.each("path", algo::kMostPathPoints, [&](const json& point, const std::string& at) {
      goal.path_W.push_back(path_point_from_json(JsonReader(point, at)));
    });
  }
  if (in.has("then")) goal.then = strict_goal(in.object("then"));
  return goal;
}

algo::SetHandGoal hand_goal_from_text(const std::string& text, const std::string& field) {
  constexpr std::array kNames{"x", "y", "z", "qx", "qy", "qz", "qw"};
  const json list = list_of(text, field);
  if (list.size() != 3 && list.size() != kNames.size()) {
    throw DocumentError(field, "must be x,y,z or x,y,z,qx,qy,qz,qw");
  }
  json goal = json::object();
  for (std::size_t k = 0; k < list.size(); ++k) goal[kNames.at(k)] = list[k];
  return hand_goal_from_json(JsonReader(goal, field));
}

algo::JointValues joints_from_text(const std::string& text, const std::string& field) {
  const json joints = {{field, list_of(text, field)}};
  return joint_values(JsonReader(joints, ""), field.c_str(), {-10, 10});
}

json to_json(const algo::SetHandGoal& goal) {
  const algo::Quaternion& a = goal.attitude_W;
  json out = {{"x", goal.position_W.x()},
              {"y", goal.position_W.y()},
              {"z", goal.position_W.z()},
              {"qw", a.w},
              {"qx", a.x},
              {"qy", a.y},
              {"qz", a.z}};
  if (goal.arm_angle) out["arm_angle"] = *goal.arm_angle;
  if (goal.base_stays) out["base_stays"] = true;
  for (const algo::Vec3& p : goal.path_W) {
    out["path"].push_back({{"x", p.x()}, {"y", p.y()}, {"z", p.z()}});
  }
  if (goal.then) out["then"] = to_json(*goal.then);
  return out;
}

std::optional<Arm> arm_from_json(const JsonReader& robot) {
  if (!robot.has("arm")) return std::nullopt;
  const JsonReader in = robot.object("arm");
  Arm arm;
  if (in.has("shoulder_offset") && in.number("shoulder_offset") != 0) {
    in.fail("shoulder_offset", "must be 0: the inverse knows no other; the mount holds an offset");
  }
  read_only_fields(in, kArm, arm);
  if (!in.has("mount")) in.fail("mount", "is missing");
  const JsonReader mount = in.object("mount");
  mount.only({"x", "y", "z", "heading"});
  arm.shoulder_R = {mount.number_or("x", 0, kShoulder),
                    mount.number_or("y", 0, kShoulder),
                    mount.number("z", {0.05, 3})};
  arm.heading = algo::wrap_angle(mount.number_or("heading", 0, {-10, 10}));
  read_values(in, "limits_deg", kLimitDegrees, kRadiansPerDegree, arm.limits);
  read_values(in, "rates_deg", kRateDegrees, kRadiansPerDegree, arm.rates);
  read_values(in, "rest_deg", kRestDegrees, kRadiansPerDegree, arm.rest);
  read_values(in, "masses", kLinkMass, 1, arm.masses);
  read_values(in, "torques", kTorque, 1, arm.torques);
  return arm;
}

json to_json(const Arm& arm) {
  json out = written(kArm, arm);
  out["mount"] = {{"x", arm.shoulder_R.x()},
                  {"y", arm.shoulder_R.y()},
                  {"z", arm.shoulder_R.z()},
                  {"heading", arm.heading}};
  out["limits_deg"] = in_degrees(arm.limits);
  out["rates_deg"] = in_degrees(arm.rates);
  out["rest_deg"] = in_degrees(arm.rest);
  out["masses"] = arm.masses;
  out["torques"] = arm.torques;
  return out;
}

std::optional<Spec> arm_spec_from_json(const JsonReader& spec) {
  if (!spec.has("arm")) return std::nullopt;
  const JsonReader in = spec.object("arm");
  Spec arm;
  read_fields(in, kArmSpec, arm);
  const json& shoulder = in.array("shoulder", 3);
  if (shoulder.size() != 3) in.fail("shoulder", "must be x, y and z");
  for (int k = 0; k < 3; ++k) {
    arm.shoulder_R[k] = finite_number(shoulder[static_cast<std::size_t>(k)], in.at("shoulder"));
  }
  arm.limits = joint_values(in, "limits");
  arm.rates = joint_values(in, "rates");
  arm.rest = joint_values(in, "rest");
  return arm;
}

json spec_json(const Spec& arm) {
  json out = written(kArmSpec, arm);
  out["shoulder"] = {arm.shoulder_R.x(), arm.shoulder_R.y(), arm.shoulder_R.z()};
  out["limits"] = arm.limits;
  out["rates"] = arm.rates;
  out["rest"] = arm.rest;
  return out;
}

}  // namespace server
