// server/lab/compare/scenes.cpp: the lists of contestants and of worlds.
#include "server/lab/compare/scenes.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "algo/pipeline/controllers.hpp"
#include "server/lab/reproduce/study_file.hpp"
#include "server/run/scenario_library.hpp"

namespace server::compare {
namespace {

constexpr double kNarrowest = 0.8;  // [m]
constexpr double kStep = 0.2;       // [m]
constexpr int kGaps = 9;

constexpr double kWall = 0.2;    // [m] thickness
constexpr double kSide = 4.0;    // [m] from the line to the hall's sides
constexpr double kBehind = 2.0;  // [m] from start and goal to the hall's ends
constexpr double kWay = 6.0;     // [m] from start to goal

/// A box of `size` along x and y about `centre_W`.
void add_box(sim::Scenario& scene, const algo::Vec2& centre_W, const algo::Vec2& size) {
  algo::Obstacle obstacle;
  obstacle.id = static_cast<std::uint32_t>(scene.obstacles.size() + 1);
  obstacle.pose_W = {centre_W.x(), centre_W.y(), 0};
  obstacle.shape = algo::Box{size.x(), size.y()};
  scene.obstacles.push_back(std::move(obstacle));
}

}  // namespace

std::string label(const Contestant& contestant) {
  return contestant.controller + (contestant.sensing == Sensing::Sonar ? " by sonar" : "");
}

std::vector<Contestant> contestants(std::span<const std::string> only) {
  const auto table = algo::builtin_controllers().entries();
  for (const std::string& name : only) {
    const auto* const end = table.data() + table.size();
    if (std::find_if(table.data(), end, [&](const auto& c) { return c.name == name; }) == end) {
      throw std::runtime_error("no controller is called '" + name + "'");
    }
  }
  std::vector<Contestant> all;
  for (const Sensing sensing : {Sensing::Laser, Sensing::Sonar}) {
    for (const algo::ControllerInfo& each : table) {
      const bool wanted = only.empty() || std::ranges::find(only, each.name) != only.end();
      const bool able = sensing == Sensing::Laser || each.by_sonar;
      if (wanted && able) all.push_back({std::string(each.name), sensing});
    }
  }
  return all;
}

std::vector<sim::Scenario> canonical_scenes() {
  const ScenarioLibrary built_in("", "");
  std::vector<sim::Scenario> scenes;
  for (const sim::Scenario& each : reproduce::embedded_study_file().scenarios) {
    scenes.push_back(built_in.load(each.name));
  }
  return scenes;
}

std::vector<double> bottleneck_gaps() {
  std::vector<double> gaps;
  gaps.reserve(kGaps);
  for (int i = 0; i < kGaps; ++i) gaps.push_back(kNarrowest + kStep * i);
  return gaps;
}

std::string bottleneck_name(double gap) {
  return fmt::format("gap-{:04d}", std::lround(gap * 1000));
}

sim::Scenario bottleneck(double gap) {
  sim::Scenario scene;
  scene.name = bottleneck_name(gap);
  scene.title = fmt::format("A wall with a gap of {:.1f} m", gap);
  scene.goal = algo::SetGoal{{kWay, 0}, std::nullopt};
  const double wing = kSide - gap / 2;  // length of the dividing wall on either side of the gap
  const double length = kWay + 2 * kBehind;
  for (const int side : {1, -1}) {
    add_box(scene, {kWay / 2, side * (gap / 2 + wing / 2)}, {kWall, wing});
    add_box(scene, {kWay / 2, side * (kSide + kWall / 2)}, {length, kWall});
    const double end = length / 2 + kWall / 2;
    add_box(scene, {kWay / 2 + side * end, 0}, {kWall, 2 * (kSide + kWall)});
  }
  return scene;
}

RunSpec make_run(sim::Scenario scene, const Contestant& contestant, std::uint64_t seed) {
  if (contestant.sensing == Sensing::Sonar) {
    sim::Sensors& sensors = scene.robot.sensors;
    sensors.lasers.clear();
    sensors.sonar = sim::SonarConfig{};
    sensors.sonar->count = 24;
    sensors.sonar->ping = 0.01;
  }
  RunOverrides overrides;
  overrides.controller = contestant.controller;
  overrides.seed = seed;
  return make_spec(std::move(scene), overrides);
}

}  // namespace server::compare
