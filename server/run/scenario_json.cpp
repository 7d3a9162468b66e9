// server/run/scenario_json.cpp: one reader and one writer for each part of the document.
#include "server/run/scenario_json.hpp"

#include <filesystem>
#include <set>

#include <fmt/format.h>

#include "algo/filter/filter.hpp"
#include "algo/pipeline/parameter_table.hpp"
#include "server/run/arm_json.hpp"
#include "server/run/library_files.hpp"
#include "server/run/motion_json.hpp"
#include "server/run/pose_json.hpp"
#include "server/run/robots_json.hpp"
#include "server/run/sensor_json.hpp"

namespace server {
namespace {

using nlohmann::json;

void read_obstacles(const JsonReader& in, sim::Scenario& scenario) {
  const json& list = in.array("obstacles", kMaxObstacles);
  std::set<std::uint32_t> ids;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string path = fmt::format("obstacles/{}", i);
    algo::Obstacle obstacle = obstacle_from_json(list[i], path);
    if (obstacle.id != 0 && !ids.insert(obstacle.id).second) {
      throw DocumentError(path + "/id", fmt::format("{} is used twice", obstacle.id));
    }
    scenario.obstacles.push_back(std::move(obstacle));
  }
  std::uint32_t next = 1;
  for (algo::Obstacle& obstacle : scenario.obstacles) {
    if (obstacle.id != 0) continue;
    while (ids.count(next) > 0) ++next;
    ids.insert(next);
    obstacle.id = next;
  }
}

void read_arm_goals(const JsonReader& in, sim::Scenario& scenario) {
  for (const char* key : {"hand_goal", "joints", "carry"}) {
    if (in.has(key) && !scenario.robot.arm) in.fail(key, "needs a robot with an arm");
  }
  if (in.has("joints")) scenario.joints = joint_values(in, "joints", {-10, 10});
  scenario.carry = in.flag_or("carry", false);
  if (scenario.carry && !scenario.goal) in.fail("carry", "leads nowhere: there is no goal");
  if (scenario.carry && !scenario.waypoints.empty()) in.fail("carry", "knows no waypoints");
  if (!in.has("hand_goal")) return;
  if (scenario.goal) in.fail("hand_goal", "cannot stand beside goal");
  const JsonReader goal = in.object("hand_goal");
  goal.only(kHandGoalFields);
  scenario.hand_goal = hand_goal_from_json(goal);
}

/// A map lies beside the scenario's file; a name from the network is never a path.
void read_map_name(const JsonReader& in, sim::Scenario& scenario) {
  scenario.map = in.text_or("map", "");
  const bool plain = scenario.map.find_first_of("/\\") == std::string::npos;
  if (!scenario.map.empty() && (!plain || !scenario.map.ends_with(".yaml"))) {
    in.fail("map", "must be the name of a .yaml file beside the scenario's");
  }
  scenario.lost = in.flag_or("lost", false);
  if (scenario.lost && scenario.map.empty()) in.fail("lost", "needs a map to be lost on");
}

void read_choices(const JsonReader& in, sim::Scenario& scenario) {
  if (const auto physics = physics_from_json(in)) scenario.physics = *physics;
  scenario.controller = in.text_or("controller", scenario.controller);
  // make_spec() knows the controllers, some of which the command line may have added.
  if (!valid_name(scenario.controller)) {
    in.fail("controller", fmt::format("'{}' is unknown", scenario.controller));
  }
  scenario.filter = in.text_or("filter", scenario.filter);
  if (!algo::find_filter(scenario.filter)) {
    in.fail("filter", fmt::format("'{}' is unknown", scenario.filter));
  }
  if (in.has("parameters")) {
    scenario.parameters =
        parameters_from_json(in.object("parameters").raw(), in.at("parameters"), {});
  }
}

}  // namespace

json to_json(const algo::Parameters& parameters) {
  json out = json::object();
  for (const algo::ParameterInfo* p : algo::parameter_table()) {
    out[std::string(p->key())] = parameters[*p];
  }
  return out;
}

algo::Parameters parameters_from_json(const json& value,
                                      const std::string& path,
                                      const algo::Parameters& base) {
  const JsonReader in(value, path);
  algo::Parameters out = base;
  for (const auto& [name, unused] : value.items()) {
    const algo::ParameterInfo* const parameter = algo::find_parameter(name);
    if (parameter == nullptr) in.fail(name, "there is no such parameter");
    out.set(*parameter, in.number(name));
  }
  if (const auto complaint = algo::refusal(out)) throw DocumentError(path, *complaint);
  return out;
}

sim::PhysicsKind physics_named(const std::string& name, const std::string& path) {
  if (name == "bullet") return sim::PhysicsKind::Bullet;
  if (name == "kinematic") return sim::PhysicsKind::Kinematic;
  throw DocumentError(path, fmt::format("is '{}', must be bullet or kinematic", name));
}

std::optional<sim::PhysicsKind> physics_from_json(const JsonReader& in) {
  const bool old = in.has("vehicle");
  if (!old && !in.has("physics")) return std::nullopt;
  if (old && in.has("physics")) in.fail("vehicle", "cannot stand beside physics, its new name");
  const char* const key = old ? "vehicle" : "physics";
  return physics_named(in.text(key, 64), in.at(key));
}

sim::Scenario scenario_from_json(const json& document, const RobotLibrary& robots) {
  const JsonReader in(document, "");
  in.only({"name",       "title",   "description", "robot",        "physics",       "period",
           "start",      "goal",    "drive",       "obstacles",    "lasers",        "sonar",
           "infrared",   "sensors", "gyro",        "bumpers",      "encoders",      "localization",
           "controller", "filter",  "parameters",  "time_limit",   "waypoints",     "loop",
           "robots",     "vehicle", "line_camera", "inclinometer", "floor_sensors", "hand_goal",
           "joints",     "carry",   "map",         "lost"});
  sim::Scenario s;
  s.name = in.text("name", 64);
  if (!valid_name(s.name)) {
    in.fail("name", "must be 1 to 64 of the characters a-z, 0-9, _ and -");
  }
  s.title = in.text_or("title", s.name);
  s.description = in.text_or("description", "");
  if (in.has("robot")) s.robot = read_robot(in, robots);
  s.period = in.number_or("period", s.period, {0.002, 1.0});
  if (in.has("goal")) s.goal = strict_goal(in.object("goal"));
  s.waypoints = waypoints_from_json(in);
  s.loop = in.flag_or("loop", false);
  s.start = start_from_json(in, s.waypoints.empty() ? s.goal : s.waypoints.front());
  if (in.has("drive")) s.drive = drive_from_json(in.object("drive"));
  if (in.has("obstacles")) read_obstacles(in, s);
  read_sensors(in, s.robot.sensors);
  const std::string localization = in.text_or("localization", "encoders");
  if (localization != "encoders" && localization != "gyro") {
    in.fail("localization", "must be \"encoders\" or \"gyro\"");
  }
  s.localization = localization == "gyro" ? sim::Localization::Gyro : sim::Localization::Encoders;
  read_arm_goals(in, s);
  read_choices(in, s);
  s.time_limit = in.number_or("time_limit", 0, {0.0, 1e6});
  read_map_name(in, s);
  read_robots(in, robots, s);
  return s;
}

json to_json(const sim::Scenario& s) {
  json out = {{"name", s.name},
              {"title", s.title},
              {"description", s.description},
              {"robot", s.log.empty() ? robot_reference(s.robot) : json(s.robot.name)},
              {"physics", s.physics == sim::PhysicsKind::Bullet ? "bullet" : "kinematic"},
              {"period", s.period},
              {"start", to_json(s.start)},
              {"controller", s.controller},
              {"filter", s.filter},
              {"parameters", json::object()},
              {"time_limit", s.time_limit},
              {"obstacles", json::array()}};
  if (s.goal) out["goal"] = to_json(*s.goal);
  for (const algo::SetGoal& waypoint : s.waypoints) out["waypoints"].push_back(to_json(waypoint));
  for (const auto& [parameter, value] : s.parameters.settings()) {
    if (value != parameter->initial) out["parameters"][std::string(parameter->key())] = value;
  }
  if (s.loop) out["loop"] = true;
  if (s.hand_goal) out["hand_goal"] = to_json(*s.hand_goal);
  if (s.carry) out["carry"] = true;
  if (!s.map.empty()) out["map"] = std::filesystem::path(s.map).filename().string();
  if (s.lost) out["lost"] = true;
  if (s.joints) out["joints"] = *s.joints;
  write_sensors(s.robot.sensors, out);
  if (s.localization == sim::Localization::Gyro) out["localization"] = "gyro";
  for (const algo::Obstacle& obstacle : s.obstacles) out["obstacles"].push_back(to_json(obstacle));
  if (s.drive != sim::DriveConfig{}) out["drive"] = to_json(s.drive);
  write_robots(s, out);
  return out;
}

}  // namespace server
