// server/run/scenario_json.cpp: one reader and one writer per document part.
#include "server/run/scenario_json.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "algo/filter/filter.hpp"
#include "algo/pipeline/controllers.hpp"
#include "algo/pipeline/parameter_table.hpp"
#include "algo/pipeline/sequencing.hpp"
#include "algo/units.hpp"
#include "server/run/json_reader.hpp"
#include "server/run/motion_json.hpp"
#include "server/run/pose_json.hpp"
#include "server/run/robots_json.hpp"
#include "server/run/sensor_json.hpp"

namespace server {
namespace {

using nlohmann::json;
constexpr std::uint64_t kMaxBeams = 4096;

sim::LaserConfig laser_from_json(const JsonReader& in) {
  in.only({"resolution_deg",
           "field_of_view_deg",
           "beams",
           "ideal",
           "mount",
           "height",
           "rolling",
           "unit",
           "range_max",
           "bias",
           "noise",
           "noise_shape",
           "mixed_pixels",
           "reflectivity",
           "dropout",
           "salt",
           "pepper"});
  const double resolution = in.number_or("resolution_deg", 0.5);
  sim::LaserConfig laser;
  try {
    laser = in.flag_or("ideal", false) ? sim::LaserConfig::ideal(resolution)
                                       : sim::LaserConfig::with_resolution(resolution);
  } catch (const std::invalid_argument& e) {
    in.fail("resolution_deg", e.what());
  }
  if (in.has("field_of_view_deg") || in.has("beams")) {
    if (in.has("resolution_deg")) in.fail("resolution_deg", "cannot stand beside beams");
    laser = sim::LaserConfig::flat(
        in.number("field_of_view_deg", {1.0, 360.0}) * algo::units::kRadiansPerDegree,
        static_cast<std::uint32_t>(in.whole("beams", kMaxBeams)),
        30.0);
  }
  if (in.has("mount")) laser.mount_R = pose_from_json(in.object("mount"), 0);
  laser.height = in.number_or("height", laser.height, {0.0, 5.0});
  laser.rolling = in.flag_or("rolling", laser.rolling);
  const std::string unit = in.text_or("unit", "mm");
  if (unit != "mm" && unit != "cm") in.fail("unit", "must be \"mm\" or \"cm\"");
  if (unit == "cm") {
    laser.unit = sim::LaserUnit::Centimetre;
    laser.range_max = 81.91;
  }
  laser.range_max = in.number_or("range_max", laser.range_max, {0.1, 81.91});
  laser.bias = in.number_or("bias", laser.bias, {0.0, 1.0});
  laser.noise = in.number_or("noise", laser.noise, {0.0, 1.0});
  const std::string shape = in.text_or("noise_shape", "gaussian");
  if (shape != "gaussian" && shape != "uniform") {
    in.fail("noise_shape", "must be \"gaussian\" or \"uniform\"");
  }
  laser.noise_shape = shape == "uniform" ? sim::NoiseShape::Uniform : sim::NoiseShape::Gaussian;
  laser.mixed_pixels = in.flag_or("mixed_pixels", laser.mixed_pixels);
  laser.reflectivity = in.flag_or("reflectivity", laser.reflectivity);
  laser.dropout = in.number_or("dropout", laser.dropout, {0.0, 1.0});
  laser.salt = in.number_or("salt", laser.salt, {0.0, 1.0});
  laser.pepper = in.number_or("pepper", laser.pepper, {0.0, 1.0});
  return laser;
}

/// Whether `degrees` is an angular resolution of the LMS200.
bool lms200_mode(double degrees) {
  const auto is = [&](double mode) { return std::abs(degrees - mode) < 1e-9; };
  return is(0.25) || is(0.5) || is(1.0);
}

json laser_to_json(const sim::LaserConfig& laser) {
  json out = {
      {"mount", to_json(laser.mount_R)},
      {"height", laser.height},
      {"rolling", laser.rolling},
      {"unit", laser.unit == sim::LaserUnit::Millimetre ? "mm" : "cm"},
      {"range_max", laser.range_max},
      {"bias", laser.bias},
      {"noise", laser.noise},
      {"noise_shape", laser.noise_shape == sim::NoiseShape::Uniform ? "uniform" : "gaussian"},
      {"mixed_pixels", laser.mixed_pixels},
      {"reflectivity", laser.reflectivity},
      {"dropout", laser.dropout},
      {"salt", laser.salt},
      {"pepper", laser.pepper}};
  const double degrees = laser.angle_increment / algo::units::kRadiansPerDegree;
  if (lms200_mode(degrees)) {
    out["resolution_deg"] = std::round(degrees * 100) / 100;
  } else {
    out["field_of_view_deg"] = laser.field_of_view / algo::units::kRadiansPerDegree;
    out["beams"] = std::lround(laser.field_of_view / laser.angle_increment) + 1;
  }
  return out;
}

void read_obstacles(const JsonReader& in, sim::Scenario& scenario) {
  const json& list = in.array("obstacles", kMaxObstacles);
  std::set<std::uint32_t> ids;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string path = fmt::format("obstacles/{}", i);
    json one = list[i];
    if (one.is_object()) one.erase("path");  // not of the obstacle as such: of this world
    algo::Obstacle obstacle = obstacle_from_json(one, path);
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
  for (std::size_t i = 0; i < list.size(); ++i) {
    const JsonReader one(list[i], fmt::format("obstacles/{}", i));
    if (!one.has("path")) continue;
    scenario.paths.push_back(path_from_json(one.object("path"), scenario.obstacles[i].id));
  }
}

void read_choices(const JsonReader& in, sim::Scenario& scenario) {
  const std::string vehicle = in.text_or("vehicle", "bullet");
  if (vehicle != "bullet" && vehicle != "kinematic") {
    in.fail("vehicle", "must be \"bullet\" or \"kinematic\"");
  }
  scenario.vehicle = vehicle == "bullet" ? sim::Vehicle::Bullet : sim::Vehicle::Kinematic;
  scenario.controller = in.text_or("controller", scenario.controller);
  if (algo::builtin_controllers().find(scenario.controller) == nullptr) {
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

bool valid_scenario_name(std::string_view name) {
  return !name.empty() && name.size() <= 64 &&
         name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_-") == std::string_view::npos;
}

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

void read_waypoints(const JsonReader& in, sim::Scenario& s) {
  const json& list = in.array("waypoints", algo::kMostGoalsAhead);
  if (!s.goal && !list.empty()) in.fail("waypoints", "lead nowhere: there is no goal");
  for (std::size_t i = 0; i < list.size(); ++i) {
    const JsonReader waypoint(list[i], fmt::format("waypoints/{}", i));
    waypoint.only({"x", "y", "heading"});
    s.waypoints.push_back(goal_from_json(waypoint));
  }
}

sim::Scenario scenario_from_json(const json& document) {
  const JsonReader in(document, "");
  in.only({"name",       "title",   "description", "robot",      "vehicle",   "period",
           "start",      "goal",    "drive",       "obstacles",  "lasers",    "sonar",
           "infrared",   "sensors", "gyro",        "bumpers",    "encoders",  "localization",
           "controller", "filter",  "parameters",  "time_limit", "waypoints", "robots"});
  sim::Scenario s;
  s.name = in.text("name", 64);
  if (!valid_scenario_name(s.name)) {
    in.fail("name", "must be 1 to 64 of the characters a-z, 0-9, _ and -");
  }
  s.title = in.text_or("title", s.name);
  s.description = in.text_or("description", "");
  s.robot = in.text_or("robot", s.robot);
  s.period = in.number_or("period", s.period, {0.002, 1.0});
  if (in.has("goal")) {
    in.object("goal").only({"x", "y", "heading"});
    s.goal = goal_from_json(in.object("goal"));
  }
  if (in.has("waypoints")) read_waypoints(in, s);
  s.start = start_from_json(in, s.waypoints.empty() ? s.goal : s.waypoints.front());
  if (in.has("drive")) s.drive = drive_from_json(in.object("drive"));
  if (in.has("obstacles")) read_obstacles(in, s);
  if (in.has("lasers")) {
    s.lasers.clear();
    const json& list = in.array("lasers", 4);
    for (std::size_t i = 0; i < list.size(); ++i) {
      s.lasers.push_back(laser_from_json({list[i], fmt::format("lasers/{}", i)}));
    }
  }
  read_sensors(in, s);
  read_choices(in, s);
  s.time_limit = in.number_or("time_limit", 0, {0.0, 1e6});
  read_robots(in, s);
  return s;
}

json to_json(const sim::Scenario& s) {
  json out = {{"name", s.name},
              {"title", s.title},
              {"description", s.description},
              {"robot", s.robot},
              {"vehicle", s.vehicle == sim::Vehicle::Bullet ? "bullet" : "kinematic"},
              {"period", s.period},
              {"start", to_json(s.start)},
              {"controller", s.controller},
              {"filter", s.filter},
              {"parameters", json::object()},
              {"time_limit", s.time_limit},
              {"lasers", json::array()},
              {"obstacles", json::array()}};
  if (s.goal) out["goal"] = to_json(*s.goal);
  for (const algo::SetGoal& waypoint : s.waypoints) out["waypoints"].push_back(to_json(waypoint));
  for (const auto& [parameter, value] : s.parameters.settings()) {
    if (value != parameter->initial) out["parameters"][std::string(parameter->key())] = value;
  }
  for (const sim::LaserConfig& laser : s.lasers) out["lasers"].push_back(laser_to_json(laser));
  write_sensors(s, out);
  for (const algo::Obstacle& obstacle : s.obstacles) out["obstacles"].push_back(to_json(obstacle));
  for (const sim::ObstaclePath& path : s.paths) {
    for (json& one : out["obstacles"]) {
      if (one["id"] == path.id) one["path"] = to_json(path);
    }
  }
  if (s.drive != sim::DriveConfig{}) out["drive"] = to_json(s.drive);
  write_robots(s, out);
  return out;
}

}  // namespace server
