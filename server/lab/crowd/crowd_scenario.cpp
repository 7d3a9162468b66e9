// server/lab/crowd/crowd_scenario.cpp: people as obstacles that come and go.
#include "server/lab/crowd/crowd_scenario.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

#include "server/lab/crowd/crossing.hpp"
#include "server/run/library_files.hpp"
#include "server/run/scenario_json.hpp"

namespace server::crowd {
namespace {

constexpr double kUntilAgain = 5;  // [s] from the end of the recording until it begins anew
constexpr std::size_t kMostLetters = 64;

/// To a millimetre or millisecond: the recordings are no finer, and files stay small.
double to_thousandth(double value) {
  return std::floor(value * 1000 + 0.5) / 1000;
}

/// `title` as a scenario's name.
std::string scenario_name(std::string_view title) {
  std::string name;
  bool between = false;  // what no name may hold becomes one underscore
  for (const char letter : title) {
    const bool upper = letter >= 'A' && letter <= 'Z';
    const char lower = upper ? static_cast<char>(letter - 'A' + 'a') : letter;
    const bool plain = valid_name({&lower, 1});
    if (plain || !between) name += plain ? lower : '_';
    between = !plain;
  }
  const std::size_t first = std::min(name.find_first_not_of('_'), name.size());
  name = name.substr(first, name.find_last_not_of('_') + 1 - first).substr(0, kMostLetters);
  return name.empty() ? "world" : name;
}

algo::Obstacle person_of(const Walker& walker, const Recording& recording) {
  algo::Obstacle person{.shape = algo::Cylinder{kPersonRadius}, .height = kPersonHeight};
  person.path =
      algo::ObstaclePath{.period = to_thousandth(recording.until - recording.from + kUntilAgain),
                         .comes_and_goes = true};
  for (const auto& key : walker.keys) {
    person.path->keys.push_back(
        {to_thousandth(key.time - recording.from),
         {to_thousandth(key.position_W.x()), to_thousandth(key.position_W.y())}});
  }
  const algo::Vec2 from_W = person.path->keys.front().position_W;
  person.pose_W = {from_W.x(), from_W.y(), 0};
  return person;
}

}  // namespace

sim::Scenario scenario_of(const Recording& recording, const sim::Scenario& robot) {
  const Way way = first_way(recording);
  sim::Scenario scenario = robot;
  scenario.name = scenario_name(recording.name);
  scenario.title = "People of " + recording.name;
  scenario.start = {
      to_thousandth(way.start_W.x), to_thousandth(way.start_W.y), way.start_W.heading};
  scenario.goal = algo::SetGoal{{to_thousandth(way.goal_W.x()), to_thousandth(way.goal_W.y())}, {}};
  scenario.waypoints.clear();
  scenario.robots.clear();
  scenario.obstacles.clear();
  for (const Walker& walker : recording.walkers) {
    if (walker.keys.size() < 2) continue;
    const bool in_the_way =
        walker.there(recording.from) &&
        (walker.keys.front().position_W - way.start_W.position()).norm() < kLeftOut;
    if (in_the_way) continue;
    scenario.obstacles.push_back(person_of(walker, recording));
    scenario.obstacles.back().id = static_cast<std::uint32_t>(scenario.obstacles.size());
  }
  const std::size_t people = scenario.obstacles.size();
  if (people == 0) throw std::runtime_error(recording.name + ": nobody in it walks");
  if (people > kMaxObstacles) {
    throw std::runtime_error(
        fmt::format("{} holds {} people; a world holds {}", recording.name, people, kMaxObstacles));
  }
  scenario.description = fmt::format(
      "{} people come, walk and go as they were recorded; they do not see the robot. After {:.0f} "
      "s "
      "the recording begins anew.",
      people,
      scenario.obstacles.front().path->period);
  return scenario;
}

}  // namespace server::crowd
