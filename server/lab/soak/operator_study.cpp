// server/lab/soak/operator_study.cpp: worlds times robots times hands.
#include "server/lab/soak/operator_study.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "server/lab/soak/indoor_world.hpp"
#include "server/run/robot_library.hpp"

namespace server::soak {
namespace {

/// The sum over the worlds of one robot.
Drive sum_of(const OperatorStudy& study, const std::string& robot, std::size_t hand) {
  Drive sum;
  for (const DrivenWorld& world : study.worlds) {
    if (world.robot != robot) continue;
    const Drive& drive = world.drives.at(hand);
    sum.seconds += drive.seconds;
    sum.ahead += drive.ahead;
    sum.back += drive.back;
    sum.turned += drive.turned;
    sum.fastest_back = std::max(sum.fastest_back, drive.fastest_back);
    sum.overturned += drive.overturned;
    for (std::size_t k = 0; k < kTouches; ++k) sum.touches.at(k) += drive.touches.at(k);
  }
  return sum;
}

std::vector<std::string> robots_of(const OperatorStudy& study) {
  std::vector<std::string> names;
  for (const DrivenWorld& world : study.worlds) {
    if (names.empty() || names.back() != world.robot) names.push_back(world.robot);
  }
  return names;
}

const std::vector<std::string> kDriveTitles{"seconds",
                                            "ahead_m",
                                            "back_m",
                                            "turned_rad",
                                            "fastest_back_m_s",
                                            "seen",
                                            "unseen",
                                            "came",
                                            "pushed",
                                            "overturned"};

void add_drive(std::vector<std::string>& line, const Drive& drive) {
  line.push_back(fmt::format("{:.0f}", drive.seconds));
  line.push_back(fmt::format("{:.1f}", drive.ahead));
  line.push_back(fmt::format("{:.1f}", drive.back));
  line.push_back(fmt::format("{:.0f}", drive.turned));
  line.push_back(fmt::format("{:.2f}", drive.fastest_back));
  for (const int touches : drive.touches) line.push_back(fmt::format("{}", touches));
  line.push_back(fmt::format("{}", drive.overturned));
}

}  // namespace

std::vector<Driven> driven_robots() {
  std::vector<Driven> robots;
  for (const char* name : {"silvermate", "jackal", "robhaz", "masuda"}) {
    robots.push_back({.name = name, .robot = builtin_robot(name)});
  }
  Driven by_ear{
      .name = "silvermate_sonars", .robot = builtin_robot("silvermate"), .controller = "vff"};
  by_ear.robot.sensors.lasers.clear();
  by_ear.robot.sensors.sonar = sim::SonarConfig{};
  robots.push_back(by_ear);
  return robots;
}

OperatorStudy run_operator(const OperatorOptions& options) {
  const std::size_t per_robot = options.worlds;
  const std::size_t all = per_robot * options.robots.size();
  const double each = options.seconds / static_cast<double>(options.worlds);
  OperatorStudy study;
  study.worlds.resize(options.pool.shard.share(all));
  experiment::for_each(all, options.pool, [&](std::size_t i, const std::stop_token& stop) {
    const Driven& driven = options.robots[i / per_robot];
    DrivenWorld& world = study.worlds[i / options.pool.shard.count];
    world.seed = options.first_seed + i % per_robot;
    world.robot = driven.name;
    sim::Scenario scenario = indoor_world(world.seed, driven.robot.radius);
    scenario.robot = driven.robot;
    scenario.controller = driven.controller;
    scenario.physics = options.physics;
    for (std::size_t hand = 0; hand < kHands.size() && !stop.stop_requested(); ++hand) {
      world.drives.at(hand) = drive_adversarially(scenario, world.seed, each, kHands.at(hand));
    }
  });
  if (options.pool.shard.index > 0) return study;
  study.places.resize(options.robots.size());
  const experiment::PoolOptions pool{.threads = options.pool.threads, .stop = options.pool.stop};
  experiment::for_each(options.robots.size(), pool, [&](std::size_t i, const std::stop_token&) {
    sim::Scenario scenario;
    scenario.robot = options.robots[i].robot;
    scenario.controller = options.robots[i].controller;
    scenario.physics = options.physics;
    scenario.drive.ramps = true;
    study.places[i] = {options.robots[i].name, drive_tight_places(scenario)};
  });
  return study;
}

int counted_contacts(const OperatorStudy& study) {
  int sum = 0;
  for (const DrivenWorld& world : study.worlds) {
    for (std::size_t hand = 0; hand < kHands.size(); ++hand) {
      if (kHands.at(hand) != Hand::Raw) sum += world.drives.at(hand).touched(Touch::Seen);
    }
  }
  return sum;
}

double share_ahead(const OperatorStudy& study, const std::string& robot) {
  std::array<double, kHands.size()> ahead{};
  for (const DrivenWorld& world : study.worlds) {
    if (world.robot != robot || indoors_of(world.seed) != Indoors::Hall) continue;
    for (std::size_t hand = 0; hand < kHands.size(); ++hand) {
      ahead.at(hand) += world.drives.at(hand).ahead;
    }
  }
  const double raw = ahead.at(static_cast<std::size_t>(Hand::Raw));
  if (!(raw > 0)) return std::numeric_limits<double>::quiet_NaN();
  return ahead.at(static_cast<std::size_t>(Hand::Guarded)) / raw;
}

experiment::Table operator_table(const OperatorStudy& study) {
  experiment::Table table{.header = {"robot", "mode"}, .words = 2};
  table.header.insert(table.header.end(), kDriveTitles.begin(), kDriveTitles.end());
  for (const std::string& robot : robots_of(study)) {
    for (std::size_t hand = 0; hand < kHands.size(); ++hand) {
      std::vector<std::string> line{robot, std::string(name(kHands.at(hand)))};
      add_drive(line, sum_of(study, robot, hand));
      table.rows.push_back(std::move(line));
    }
  }
  return table;
}

experiment::Table places_table(const OperatorStudy& study) {
  experiment::Table table{
      .header = {"robot", "ahead of raw's in halls", "doors passed", "walls left"}};
  for (const auto& [robot, places] : study.places) {
    const double share = share_ahead(study, robot);
    table.rows.push_back({robot,
                          std::isnan(share) ? "" : fmt::format("{:.2f}", share),
                          fmt::format("{} of {}", places.doors_passed, kDoorPoses),
                          fmt::format("{} of {}", places.walls_left, kWallPoses)});
  }
  return table;
}

experiment::Table operator_rows(const OperatorStudy& study) {
  experiment::Table table{.header = {"robot", "mode", "place", "world"}, .words = 3};
  table.header.insert(table.header.end(), kDriveTitles.begin(), kDriveTitles.end());
  for (const DrivenWorld& world : study.worlds) {
    for (std::size_t hand = 0; hand < kHands.size(); ++hand) {
      std::vector<std::string> line{world.robot,
                                    std::string(name(kHands.at(hand))),
                                    std::string(name(indoors_of(world.seed))),
                                    fmt::format("{}", world.seed)};
      add_drive(line, world.drives.at(hand));
      table.rows.push_back(std::move(line));
    }
  }
  return table;
}

}  // namespace server::soak
