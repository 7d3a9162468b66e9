// server/experiment/barn_file.cpp: reads worlds and sets up the benchmark's robot.
#include "server/experiment/barn_file.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "algo/filter/filter.hpp"
#include "algo/strip/strip_law.hpp"
#include "algo/units.hpp"
#include "server/run/json_limits.hpp"
#include "server/run/json_reader.hpp"
#include "server/run/robot_library.hpp"
#include "server/run/text_file.hpp"

namespace server::barn {
namespace {

using nlohmann::json;
using namespace algo::units;

constexpr std::size_t kMaxWorlds = 10'000;
constexpr std::size_t kMaxObstacles = 5000;
constexpr std::size_t kMaxKeys = 10'000;
constexpr NumberRange kCoordinate{-1e4, 1e4};
constexpr double kObstacleHeight = 1.0;  // [m]

/// The `count` numbers of the array `value`.
std::vector<double> numbers(const json& value, const std::string& path, std::size_t count) {
  if (!value.is_array() || value.size() != count) {
    throw DocumentError(path, fmt::format("must be a list of {} numbers", count));
  }
  std::vector<double> out;
  for (std::size_t i = 0; i < count; ++i) {
    out.push_back(finite_number(value[i], fmt::format("{}/{}", path, i), kCoordinate));
  }
  return out;
}

void add_cylinder(World& world, double x, double y, double radius) {
  algo::Obstacle obstacle;
  obstacle.id = static_cast<std::uint32_t>(world.obstacles.size() + 1);
  obstacle.pose_W = {x, y, 0};
  obstacle.shape = algo::Cylinder{radius};
  obstacle.height = kObstacleHeight;
  world.obstacles.push_back(std::move(obstacle));
}

void add_moving(World& world, const JsonReader& in) {
  algo::ObstaclePath path;
  path.period = in.number("period", {0.1, 1e5});
  in.each("keys", kMaxKeys, [&](const json& value, const std::string& at) {
    const std::vector<double> key = numbers(value, at, 3);
    if (!path.keys.empty() && key[0] <= path.keys.back().time) {
      throw DocumentError(at, "must be later than the key before");
    }
    path.keys.push_back({key[0], {key[1], key[2]}});
  });
  if (path.keys.empty()) in.fail("keys", "must hold one key [t, x, y] at least");
  add_cylinder(world,
               path.keys.front().position_W.x(),
               path.keys.front().position_W.y(),
               in.number("radius", {0.01, 10}));
  world.obstacles.back().path = std::move(path);
}

World world_from_json(const JsonReader& in) {
  World world;
  world.id = in.whole("id", 1'000'000);
  const std::vector<double> start = numbers(in.array("start", 3), in.at("start"), 3);
  world.start = {start[0], start[1], algo::wrap_angle(start[2])};
  const std::vector<double> goal = numbers(in.array("goal", 2), in.at("goal"), 2);
  world.goal = {goal[0], goal[1]};
  world.goal_radius = in.number_or("goal_radius", 1, {0.01, 100});
  world.optimal_length = in.number("optimal_path_length", {0.01, 1e5});
  world.difficulty = in.text_or("difficulty", "");
  const double radius = in.number_or("radius", 0.075, {0.001, 10});
  in.each("obstacles", kMaxObstacles, [&](const json& value, const std::string& at) {
    if (value.is_object()) {
      add_moving(world, {value, at});
    } else {
      const std::vector<double> centre = numbers(value, at, 2);
      add_cylinder(world, centre[0], centre[1], radius);
    }
  });
  return world;
}

/// Nominal: a wide and precise scanner, one tick of delay. Stress: a narrower, shorter and noisier
/// scanner, half the acceleration, twice the delay, slip and drifting odometry, all at once.
void equip(sim::Scenario& scenario, const Conditions& conditions) {
  sim::DriveConfig& drive = scenario.drive;
  drive.ramps = true;
  drive.max_v = 2.0;
  if (conditions.stress) {
    sim::LaserConfig laser = sim::LaserConfig::flat(180_deg, 361, 8.0);
    laser.noise = 0.02;
    scenario.robot.sensors.lasers = {laser};
    drive.max_omega = 1.5;
    drive.max_acceleration = 1.5;
    drive.max_angular_acceleration = 4;
    drive.delay_ticks = 2;
    drive.yaw_slip = 0.10;
    drive.odometry_scale = 0.02;
  } else {
    sim::LaserConfig laser = sim::LaserConfig::flat(270_deg, 720, 30.0);
    laser.noise = 0.01;
    scenario.robot.sensors.lasers = {laser};
    drive.max_omega = 2.5;
    drive.max_acceleration = 3;
    drive.max_angular_acceleration = 8;
    drive.delay_ticks = 1;
  }
  if (conditions.scanner == Scanner::Lms200) {
    scenario.robot.sensors.lasers = {sim::LaserConfig::with_resolution(0.5)};
  }
  // Low enough to see every obstacle, and clear of the hull.
  scenario.robot.sensors.lasers.front().height = 0.30;
  if (conditions.robot) replace_robot(scenario, *conditions.robot);
}

}  // namespace

std::vector<World> worlds_from_json(const json& document) {
  const JsonReader in(document, "");
  std::vector<World> worlds;
  in.each("worlds", kMaxWorlds, [&](const json& value, const std::string& at) {
    worlds.push_back(world_from_json({value, at}));
  });
  if (worlds.empty()) in.fail("worlds", "must hold one world at least");
  return worlds;
}

std::vector<World> read_worlds(const std::string& file) {
  const std::string text = read_text(file);
  try {
    return worlds_from_json(parse_json(text, kOwnDocument));
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(file + ": " + e.what());
  }
}

std::vector<World> worlds_numbered(std::vector<World> worlds,
                                   const std::vector<std::uint64_t>& numbers) {
  for (const std::uint64_t number : numbers) {
    if (std::ranges::find(worlds, number, &World::id) == worlds.end()) {
      throw std::runtime_error(fmt::format("no world of the file has the number {}", number));
    }
  }
  std::erase_if(worlds, [&](const World& world) {
    return std::ranges::find(numbers, world.id) == numbers.end();
  });
  return worlds;
}

sim::Scenario scenario_of(const World& world, const Conditions& conditions) {
  sim::Scenario scenario;
  const bool moving = algo::any_moves(world.obstacles);
  scenario.name = fmt::format("{}-{}", moving ? "dynabarn" : "barn", world.id);
  scenario.title = fmt::format("{} world {}", moving ? "DynaBARN" : "BARN", world.id);
  scenario.robot = builtin_robot("jackal");
  scenario.physics = conditions.physics;
  scenario.period = 0.05;
  scenario.start = world.start;
  scenario.goal = algo::SetGoal{world.goal, std::nullopt};
  scenario.obstacles = world.obstacles;
  for (algo::Obstacle& obstacle : scenario.obstacles) {
    if (!obstacle.path) continue;
    obstacle.path->phase = conditions.phase;
    const algo::Vec2 at_W = obstacle.path->at(0);
    obstacle.pose_W = {at_W.x(), at_W.y(), 0};
  }
  equip(scenario, conditions);
  const auto most = [](const algo::ParameterInfo& limit, double value) {
    return std::clamp(value, limit.min, limit.max);
  };
  const double max_v = most(algo::kMaxSpeed, scenario.drive.max_v.value_or(scenario.robot.max_v));
  const double max_omega =
      most(algo::kMaxTurnRate, scenario.drive.max_omega.value_or(scenario.robot.max_omega));
  scenario.controller = conditions.controller;
  if (scenario.controller.empty()) scenario.controller = moving ? "strip_moving" : "strip";
  scenario.filter = "median";
  scenario.parameters = {{&algo::kContractionGain, 0.4},
                         {&algo::kRepulsionGain, 0.6},
                         {&algo::kSafetyDistance, 0.75},
                         {&algo::kMaxSpeed, max_v},
                         {&algo::kMaxTurnRate, max_omega},
                         {&algo::kGoalReach, std::min(0.3, world.goal_radius)},
                         {&algo::kFilterHalfWidth, 2}};
  scenario.time_limit = 100;
  return scenario;
}

}  // namespace server::barn
