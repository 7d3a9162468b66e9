// server/run/run_spec.cpp: the one place that knows every robot and controller by name.
#include "server/run/run_spec.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "algo/driving.hpp"
#include "algo/filter/filter.hpp"
#include "algo/pipeline/controllers.hpp"
#include "algo/pipeline/parameter_table.hpp"
#include "server/run/arm_json.hpp"
#include "server/run/drawn_map.hpp"
#include "server/run/fleet_robot.hpp"
#include "server/run/ground_json.hpp"
#include "server/run/hardware.hpp"
#include "server/run/io_thread.hpp"
#include "server/run/json_fields.hpp"
#include "server/run/map_robot.hpp"
#include "server/run/paths.hpp"
#include "server/run/pose_json.hpp"
#include "server/run/scenario_json.hpp"
#include "sim/replay.hpp"
#include "sim/world.hpp"

namespace server {
namespace {

using nlohmann::json;
constexpr std::uint64_t kMaxSeed = (std::uint64_t{1} << 53) - 1;  // exact in a JSON number

/// @param at  prefix of the fields in the document: "" or "robots/3/"
void check_choices(const algo::ControllerCatalogue& catalogue,
                   const std::string& at,
                   const std::string& controller_name,
                   const std::string& filter,
                   const sim::Sensors& sensors) {
  const algo::ControllerInfo* const controller = catalogue.find(controller_name);
  if (controller == nullptr) {
    std::string known;
    for (const auto& c : catalogue.entries()) known += fmt::format(" {}", c.name);
    throw DocumentError(at + "controller",
                        fmt::format("'{}' is unknown; known are{}", controller_name, known));
  }
  if (!sensors.sonar && !sensors.looks_ahead()) {
    throw DocumentError(at + "lasers",
                        "none looks ahead, and there is no sonar ring: the robot would wait for a "
                        "scan for ever");
  }
  if (!sensors.has_laser() && !controller->by_sonar) {
    std::string fit;
    for (const auto& c : catalogue.entries()) fit += c.by_sonar ? fmt::format(" {}", c.name) : "";
    throw DocumentError(
        at + "controller",
        fmt::format(
            "'{}' needs a laser; with a sonar ring alone there are{}", controller_name, fit));
  }
  if (!algo::find_filter(filter)) {
    throw DocumentError(
        at + "filter",
        fmt::format("'{}' is unknown; known are pseudomedian, median, lulu, none", filter));
  }
}

void check_parameters(const algo::ControllerCatalogue& catalogue,
                      const std::string& at,
                      const std::string& controller,
                      const algo::Parameters& parameters) {
  auto complaint = algo::refusal(parameters);
  const auto& refusal = catalogue.at(controller).refusal;
  if (!complaint && refusal) complaint = refusal(parameters);
  if (complaint) throw DocumentError(at + "parameters", *complaint);
}

/// The pipeline of `robot` in `scenario`, whose parameters are those of the run.
algo::PipelineConfig pipeline_config(const sim::OtherRobot& robot, const sim::Scenario& scenario) {
  algo::PipelineConfig config{.controller = robot.controller.value_or(scenario.controller),
                              .filter = *algo::find_filter(robot.filter.value_or(scenario.filter)),
                              .parameters = scenario.parameters,
                              .by_hand = false};
  for (const auto& [parameter, value] : robot.parameters) config.parameters.set(*parameter, value);
  return config;
}

/// Throws DocumentError naming the wrong field of the first robot that cannot run.
void check_others(const algo::ControllerCatalogue& catalogue, const sim::Scenario& scenario) {
  for (std::size_t i = 0; i < scenario.robots.size(); ++i) {
    const std::string at = fmt::format("robots/{}/", i);
    const sim::OtherRobot& robot = scenario.robots[i];
    check_choices(catalogue,
                  at,
                  robot.controller.value_or(scenario.controller),
                  robot.filter.value_or(scenario.filter),
                  (robot.robot ? *robot.robot : scenario.robot).sensors);
    const algo::PipelineConfig config = pipeline_config(robot, scenario);
    check_parameters(catalogue, at, config.controller, config.parameters);
  }
}

/// The goals as requests, in this order.
std::vector<algo::Request> requests_of(const std::vector<algo::SetGoal>& goals) {
  std::vector<algo::Request> requests;
  for (const algo::SetGoal& goal : goals) {
    if (requests.empty()) {
      requests.emplace_back(goal);
    } else {
      requests.emplace_back(algo::AddGoal{goal});
    }
  }
  return requests;
}

std::vector<RobotPlan> plans_of_others(const RunSpec& spec) {
  const sim::Scenario& scenario = spec.scenario;
  std::vector<RobotPlan> plans;
  plans.reserve(scenario.robots.size());
  for (const sim::OtherRobot& robot : scenario.robots) {
    plans.push_back({.pipeline = pipeline_config(robot, scenario),
                     .first = requests_of(robot.goals ? *robot.goals : way_of(scenario)),
                     .controllers = spec.controllers});
  }
  return plans;
}

void choose_arm(sim::Scenario& scenario, const RunOverrides& overrides) {
  if (!scenario.robot.arm && (overrides.hand_goal || overrides.joints)) {
    throw DocumentError(overrides.hand_goal ? "hand_goal" : "joints", "needs a robot with an arm");
  }
  if (overrides.joints) scenario.joints = overrides.joints;
  if (!overrides.hand_goal) return;
  scenario.goal.reset();
  scenario.waypoints.clear();
  scenario.loop = false;
  scenario.carry = false;
  scenario.hand_goal = overrides.hand_goal;
}

std::shared_ptr<const KnownMap> choose_map(sim::Scenario& scenario, const RunOverrides& overrides) {
  scenario.lost = scenario.lost || overrides.lost;
  if (overrides.map) scenario.map = overrides.map->path;
  if (overrides.lost && !overrides.map && scenario.map.empty()) {
    throw DocumentError("--lost", "needs --map FILE, or a scenario that names its map");
  }
  if (overrides.map || scenario.map.empty()) return overrides.map;
  if (!std::filesystem::path(scenario.map).has_parent_path()) {
    throw DocumentError("map", "can be read only beside the scenario's file");
  }
  try {
    return known_map(scenario.map);
  } catch (const std::exception& error) {
    throw DocumentError("map", without_folders(error.what()));
  }
}

/// A robot without an arm makes no use of them.
std::vector<algo::Obstacle> declared_of(const sim::Scenario& scenario) {
  return scenario.robot.arm ? scenario.obstacles : std::vector<algo::Obstacle>{};
}

}  // namespace

std::vector<algo::SetGoal> way_of(const sim::Scenario& scenario) {
  if (!scenario.goal) return {};
  std::vector<algo::SetGoal> goals = scenario.waypoints;
  goals.push_back(*scenario.goal);
  return goals;
}

algo::SetGoals route_of(const sim::Scenario& scenario) {
  std::vector<algo::SetGoal> way = way_of(scenario);
  if (scenario.loop && way.size() == 1) way.push_back({scenario.start.position()});
  return {std::move(way), 0, scenario.loop};
}

RunOverrides overrides_from_json(const json& body) {
  const JsonReader in(body, "");
  RunOverrides out;
  if (in.has("controller")) out.controller = in.text("controller", 64);
  if (in.has("filter")) out.filter = in.text("filter", 64);
  out.physics = physics_from_json(in);
  if (in.has("robot")) out.robot = body["robot"];
  if (in.has("seed")) out.seed = in.whole("seed", kMaxSeed);
  if (in.has("parameters")) out.parameters = in.object("parameters").raw();
  return out;
}

double pace_from_json(const json& body, const char* key, double fallback) {
  const JsonReader in(body, "");
  const double pace = in.number_or(key, fallback, {0, 1000});
  if (pace > 0 && pace < 0.01) in.fail(key, "must be 0, as fast as it goes, or at least 0.01");
  return pace;
}

RunSpec make_spec(sim::Scenario scenario,
                  const RunOverrides& overrides,
                  const RobotLibrary& robots) {
  if (!overrides.robot.is_null()) {
    choose_robot(scenario, overrides.robot, robots);
  }
  if (overrides.controller) scenario.controller = *overrides.controller;
  if (overrides.filter) scenario.filter = *overrides.filter;
  if (overrides.physics) scenario.physics = *overrides.physics;
  choose_arm(scenario, overrides);
  RunSpec spec;
  spec.controllers = overrides.controllers;
  spec.map = choose_map(scenario, overrides);
  const algo::ControllerCatalogue& catalogue = controllers_of(spec);
  check_choices(catalogue, "", scenario.controller, scenario.filter, scenario.robot.sensors);
  spec.parameters = parameters_from_json(overrides.parameters, "parameters", scenario.parameters);
  check_parameters(catalogue, "", scenario.controller, spec.parameters);
  spec.seed = overrides.seed.value_or(1);
  // The run's document must be complete, parameters included.
  scenario.parameters = spec.parameters;
  check_others(catalogue, scenario);
  spec.scenario = std::move(scenario);
  return spec;
}

const char* source_of(const RunSpec& spec) {
  if (spec.hardware) return "hardware";
  return spec.scenario.log.empty() ? "simulation" : "replay";
}

const char* physics_of(const RunSpec& spec) {
  if (spec.hardware) return "hardware";
  if (!spec.scenario.log.empty()) return "log";
  return spec.scenario.physics == sim::PhysicsKind::Bullet ? "bullet" : "kinematic";
}

namespace {

std::unique_ptr<algo::Robot> make_bare_robot(const RunSpec& spec) {
  if (spec.hardware) return make_run(*spec.hardware);
  if (!spec.scenario.log.empty()) return std::make_unique<sim::Replay>(spec.scenario.log);
  if (spec.scenario.robots.empty()) {
    return std::make_unique<sim::World>(spec.scenario, spec.seed);
  }
  return std::make_unique<FleetRobot>(spec.scenario, spec.seed, plans_of_others(spec));
}

/// Where the robot begins on its map. A log's odometry and a real robot's begin anywhere.
std::optional<algo::Pose2> known_start(const RunSpec& spec) {
  if (spec.scenario.lost || spec.hardware || !spec.scenario.log.empty()) return std::nullopt;
  return spec.scenario.start;
}

}  // namespace

std::unique_ptr<algo::Robot> make_robot(const RunSpec& spec) {
  net::not_on_io_thread("Building a world");
  std::unique_ptr<algo::Robot> robot = make_bare_robot(spec);
  if (!spec.map) return robot;
  if (!robot->spec().has_laser) {
    throw DocumentError("map", "needs a robot with a scanner that looks ahead");
  }
  const auto waits = spec.scenario.log.empty() ? MapRobot::Waits::Yes : MapRobot::Waits::No;
  return std::make_unique<MapRobot>(std::move(robot), *spec.map, known_start(spec), waits);
}

algo::PipelineConfig pipeline_config(const RunSpec& spec) {
  return {.controller = spec.scenario.controller,
          .filter = *algo::find_filter(spec.scenario.filter),
          .parameters = spec.parameters,
          .run = {.scenario = spec.scenario.name,
                  .seed = spec.seed,
                  .map = spec.map ? spec.map->space : nullptr},
          .declared = declared_of(spec.scenario)};
}

const algo::ControllerCatalogue& controllers_of(const RunSpec& spec) {
  return spec.controllers ? *spec.controllers : algo::builtin_controllers();
}

bool drives_from_outside(const RunSpec& spec) {
  return controllers_of(spec).at(spec.scenario.controller).outside;
}

std::vector<algo::Request> first_requests(const RunSpec& spec) {
  if (!spec.scenario.log.empty()) return {};
  if (spec.scenario.carry) return {algo::Carry{*spec.scenario.goal}};
  std::vector<algo::Request> requests = requests_of(way_of(spec.scenario));
  if (spec.scenario.hand_goal) requests.emplace_back(*spec.scenario.hand_goal);
  return requests;
}

double time_limit(const RunSpec& spec) {
  if (!spec.scenario.log.empty()) return 0;
  if (spec.scenario.time_limit > 0) return spec.scenario.time_limit;
  if (!spec.scenario.goal) return spec.scenario.hand_goal ? 120.0 : 60.0;
  double way = 0;
  algo::Vec2 from_W = spec.scenario.start.position();
  for (const algo::SetGoal& goal : way_of(spec.scenario)) {
    way += (goal.position_W - from_W).norm();
    from_W = goal.position_W;
  }
  return std::max(1.0, 5.0 * way / spec.parameters[algo::kMaxSpeed]);
}

namespace {

using Robot = algo::RobotSpec;
/// Without limits: values that a run was once accepted with are read unchanged.
constexpr Field<Robot> kRobot[] = {
    {"name"},
    required("radius", &Robot::radius),
    {"half_length", &Robot::half_length},
    {"half_width", &Robot::half_width},
    required("half_track", &Robot::half_track),
    required("period", &Robot::period),
    required("max_v", &Robot::max_v),
    required("max_omega", &Robot::max_omega),
    required("max_acceleration", &Robot::max_acceleration),
    required("max_angular_acceleration", &Robot::max_angular_acceleration),
    {"max_jerk", &Robot::max_jerk},
    {"max_angular_jerk", &Robot::max_angular_jerk},
    {"command_delay", &Robot::command_delay},
    {"has_laser", &Robot::has_laser},
    {"has_ring", &Robot::has_ring},
    {"drives", &Robot::drives},
    {"channels"},
};

json to_json(const algo::ChannelInfo& channel) {
  json out = {{"name", channel.name},
              {"kind", channel.kind},
              {"unit", channel.unit},
              {"values", channel.values}};
  if (channel.mount_R) out["mount"] = server::to_json(*channel.mount_R);
  return out;
}

algo::ChannelInfo channel_from_json(const JsonReader& in) {
  constexpr std::uint64_t kMostValues = 65536;  // values of a reading
  algo::ChannelInfo channel;
  channel.name = in.text("name");
  channel.kind = in.text_or("kind", "");
  channel.unit = in.text_or("unit", "");
  channel.values = static_cast<std::uint32_t>(in.whole_or("values", 1, kMostValues));
  if (in.has("mount")) channel.mount_R = pose_from_json(in.object("mount"), 0);
  return channel;
}

}  // namespace

json to_json(const algo::RobotSpec& robot) {
  json channels = json::array();
  for (const algo::ChannelInfo& channel : robot.channels) channels.push_back(to_json(channel));
  json out = written(kRobot, robot);
  out["name"] = robot.name;
  out["channels"] = std::move(channels);
  write_ground(robot, out);
  if (robot.arm) out["arm"] = spec_json(*robot.arm);
  return out;
}

algo::RobotSpec robot_spec_from_json(const json& value) {
  const JsonReader in(value, "robot");
  algo::RobotSpec robot;
  robot.name = in.text("name", SIZE_MAX);
  read_fields(in, kRobot, robot);
  if (in.has("channels")) {
    const json& list = in.array("channels", algo::kMostChannels);
    for (const json& each : list) robot.channels.push_back(channel_from_json({each, "robot"}));
  }
  read_ground(in, robot);
  robot.arm = arm_spec_from_json(in);
  return robot;
}

json run_document(const RunSpec& spec, const algo::RobotSpec& robot) {
  json out = {
      {"scenario", to_json(spec.scenario)}, {"source", source_of(spec)}, {"robot", to_json(robot)}};
  if (drives_from_outside(spec)) out["answers"] = "recorded";
  if (spec.map && spec.map->space && !drives_from_outside(spec)) {
    out["map"] = to_json(*spec.map->space);
  }
  for (const algo::Obstacle& other : sim::other_robots(spec.scenario)) {
    out["others"].push_back(to_json(other));
  }
  return out;
}

}  // namespace server
