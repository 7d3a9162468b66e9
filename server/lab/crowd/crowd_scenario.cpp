// server/lab/crowd/crowd_scenario.cpp: people as obstacles that come and go.
#include "server/lab/crowd/crowd_scenario.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

#include "server/lab/crowd/crossing.hpp"
#include "server/run/library_files.hpp"
#include "server/run/motion_json.hpp"
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

/// Throws a sentence if `recording` and a pause are longer than a path.
void check_span(const Recording& recording) {
  const double most = kMaxPathTime - kUntilAgain;
  if (recording.until - recording.from <= most) return;
  const auto last =
      std::ranges::max_element(recording.walkers, {}, [](const Walker& w) { return w.until(); });
  throw std::runtime_error(fmt::format(
      "{} lasts {:.0f} s, from frame {} to frame {} of person {}; a scenario holds {:.0f} s",
      recording.name,
      recording.until - recording.from,
      frame_at(recording.from),
      frame_at(recording.until),
      last->id,
      most));
}

/// Throws a sentence if no path can hold the places of `walker`.
void check_places(const Walker& walker, const Recording& recording) {
  if (walker.keys.size() > kMaxPathKeys) {
    throw std::runtime_error(
        fmt::format("{}: person {} is in {} frames; a scenario holds {} of one person",
                    recording.name,
                    walker.id,
                    walker.keys.size(),
                    kMaxPathKeys));
  }
  const auto close = std::ranges::adjacent_find(
      walker.keys, {}, [&](const auto& key) { return to_thousandth(key.time - recording.from); });
  if (close == walker.keys.end()) return;
  throw std::runtime_error(fmt::format(
      "{}: frames {} and {} of person {} fall on one millisecond; a scenario's times are whole "
      "milliseconds",
      recording.name,
      frame_at(close->time),
      frame_at(std::next(close)->time),
      walker.id));
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
  check_span(recording);
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
    check_places(walker, recording);
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
