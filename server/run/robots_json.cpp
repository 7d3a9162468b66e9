// server/run/robots_json.cpp: one reader and one writer.
#include "server/run/robots_json.hpp"

#include <algorithm>
#include <array>
#include <string>

#include <fmt/format.h>

#include "algo/filter/filter.hpp"
#include "algo/intent.hpp"
#include "algo/pipeline/parameter_table.hpp"
#include "server/run/library_files.hpp"
#include "server/run/pose_json.hpp"
#include "server/run/robot_json.hpp"
#include "server/run/scenario_json.hpp"
#include "server/run/sensor_json.hpp"

namespace server {
namespace {

using nlohmann::json;
constexpr std::size_t kMostBodies = 40'000;  // memory: each robot's world has all obstacles

/// Waypoints and goal in order; empty if the goal is null; nothing if neither is given.
std::optional<std::vector<algo::SetGoal>> own_goals(const JsonReader& in) {
  std::vector<algo::SetGoal> goals = waypoints_from_json(in);
  if (in.has("goal")) {
    goals.push_back(strict_goal(in.object("goal")));
  } else if (!in.raw().contains("goal")) {
    return std::nullopt;
  }
  return goals;
}

/// The first waypoint or goal of `robot`.
std::optional<algo::SetGoal> first_goal(const sim::OtherRobot& robot,
                                        const sim::Scenario& scenario) {
  if (!robot.goals) return scenario.waypoints.empty() ? scenario.goal : scenario.waypoints.front();
  if (robot.goals->empty()) return std::nullopt;
  return robot.goals->front();
}

/// Whether the document of a robot lists its sensors.
bool brings_sensors(const json& robot) {
  constexpr std::array kSensors{"lasers",
                                "sonar",
                                "infrared",
                                "sensors",
                                "gyro",
                                "bumpers",
                                "encoders",
                                "line_camera",
                                "inclinometer",
                                "floor_sensors"};
  return robot.is_object() &&
         std::ranges::any_of(kSensors, [&](const char* key) { return robot.contains(key); });
}

sim::OtherRobot other_from_json(const JsonReader& in,
                                const RobotLibrary& robots,
                                const sim::Scenario& scenario) {
  in.only({"start", "robot", "goal", "waypoints", "controller", "filter", "parameters"});
  sim::OtherRobot robot;
  if (!in.has("start")) in.fail("start", "is missing");
  robot.goals = own_goals(in);
  robot.start = start_from_json(in, first_goal(robot, scenario));
  if (in.has("robot")) {
    robot.robot = read_robot(in, robots);
    if (!brings_sensors(in.raw()["robot"])) robot.robot->sensors = scenario.robot.sensors;
  }
  if (in.has("controller")) {
    robot.controller = in.text("controller", 64);
    if (!valid_name(*robot.controller)) {
      in.fail("controller", fmt::format("'{}' is unknown", *robot.controller));
    }
  }
  if (in.has("filter")) {
    robot.filter = in.text("filter", 64);
    if (!algo::find_filter(*robot.filter)) {
      in.fail("filter", fmt::format("'{}' is unknown", *robot.filter));
    }
  }
  if (in.has("parameters")) {
    const json& given = in.object("parameters").raw();
    parameters_from_json(given, in.at("parameters"), scenario.parameters);
    for (const auto& [name, value] : given.items()) {
      robot.parameters.push_back({algo::find_parameter(name), value.get<double>()});
    }
  }
  return robot;
}

json other_to_json(const sim::OtherRobot& robot, const sim::Scenario& scenario) {
  json out = {{"start", to_json(robot.start)}};
  if (robot.robot) {
    const bool alike = same_sensors(robot.robot->sensors, scenario.robot.sensors);
    out["robot"] = alike ? robot_reference(*robot.robot) : robot_document(*robot.robot);
  }
  if (robot.goals && robot.goals->empty()) out["goal"] = nullptr;
  if (robot.goals && !robot.goals->empty()) {
    out["goal"] = to_json(robot.goals->back());
    for (std::size_t i = 0; i + 1 < robot.goals->size(); ++i) {
      out["waypoints"].push_back(to_json((*robot.goals)[i]));
    }
  }
  if (robot.controller) out["controller"] = *robot.controller;
  if (robot.filter) out["filter"] = *robot.filter;
  for (const auto& [parameter, value] : robot.parameters) {
    out["parameters"][std::string(parameter->key())] = value;
  }
  return out;
}

}  // namespace

void read_robots(const JsonReader& in, const RobotLibrary& robots, sim::Scenario& scenario) {
  if (!in.has("robots")) return;
  in.each("robots", sim::kMostRobots - 1, [&](const json& value, const std::string& at) {
    scenario.robots.push_back(other_from_json({value, at}, robots, scenario));
  });
  const std::size_t all = scenario.robots.size() + 1;
  if (all * scenario.obstacles.size() > kMostBodies) {
    in.fail("robots",
            fmt::format("{} robots among {} obstacles are too many; their product must be at "
                        "most {}",
                        all,
                        scenario.obstacles.size(),
                        kMostBodies));
  }
}

void write_robots(const sim::Scenario& s, json& out) {
  for (const sim::OtherRobot& robot : s.robots) {
    out["robots"].push_back(other_to_json(robot, s));
  }
}

}  // namespace server
