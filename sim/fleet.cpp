// sim/fleet.cpp: one World per robot, and the two phases of a period.
#include "sim/fleet.hpp"

#include <stdexcept>
#include <utility>
#include <variant>

namespace sim {
namespace {

std::string name_of(std::size_t k) {
  return "Robot " + std::to_string(k + 1);
}

std::uint32_t id_of(std::size_t k) {
  return kRobotIds + static_cast<std::uint32_t>(k) + 1;
}

/// Robot `k` at its start, as others perceive it.
algo::Obstacle body_of(const Scenario& scenario, std::size_t k) {
  algo::Obstacle body;
  if (k == 0) {
    body = robot_body(scenario.robot, scenario.start);
  } else {
    const OtherRobot& robot = scenario.robots[k - 1];
    body = robot_body(robot.robot.value_or(scenario.robot), robot.start);
  }
  body.id = id_of(k);
  return body;
}

/// The scenario from the view of robot `k`.
Scenario scenario_of(const Scenario& scenario, std::size_t k) {
  Scenario own = scenario;
  own.robots.clear();
  if (k == 0) return own;
  const OtherRobot& robot = scenario.robots[k - 1];
  own.start = robot.start;
  own.robot = robot.robot.value_or(scenario.robot);
  own.joints.reset();  // those are of the first robot
  return own;
}

/// Different robots draw independent noise.
std::uint64_t seed_of(std::uint64_t seed, std::size_t k) {
  return seed + 0x9e3779b97f4a7c15ULL * k;
}

std::unique_ptr<World> world_of(const Scenario& scenario, std::uint64_t seed, std::size_t k) {
  try {
    return std::make_unique<World>(scenario_of(scenario, k), seed_of(seed, k));
  } catch (const std::invalid_argument& e) {
    if (k == 0) throw;
    throw std::invalid_argument(name_of(k) + ": " + e.what());
  }
}

/// The robot that `request` would edit, by its index from 0.
std::optional<std::size_t> robot_in(const algo::Request& request) {
  std::uint32_t id = 0;
  if (const auto* add = std::get_if<algo::AddObstacle>(&request)) id = add->obstacle.id;
  if (const auto* change = std::get_if<algo::ChangeObstacle>(&request)) id = change->obstacle.id;
  if (const auto* move = std::get_if<algo::MoveObstacle>(&request)) id = move->id;
  if (const auto* remove = std::get_if<algo::RemoveObstacle>(&request)) id = remove->id;
  if (id <= kRobotIds) return std::nullopt;
  return id - kRobotIds - 1;
}

}  // namespace

Fleet::Fleet(const Scenario& scenario, std::uint64_t seed, ForEach for_each)
    : for_each_(std::move(for_each)) {
  if (scenario.robots.size() >= kMostRobots) {
    throw std::invalid_argument("A world holds at most " + std::to_string(kMostRobots) +
                                " robots.");
  }
  for (std::size_t k = 0; k <= scenario.robots.size(); ++k) {
    worlds_.push_back(world_of(scenario, seed, k));
    bodies_.push_back(body_of(scenario, k));
  }
  for (std::size_t k = 0; k < size(); ++k) {
    peers_.push_back({{}, worlds_[k]->hull().radius, &bodies_[k]});
  }
  check_starts();
  meet();
}

void Fleet::check_starts() const {
  for (std::size_t k = 0; k < size(); ++k) {
    ObstacleSet alone;
    alone.add(bodies_[k]);
    for (std::size_t i = 0; i < k; ++i) {
      if (alone.clearance(worlds_[i]->hull(), bodies_[i].pose_W) >= 0) continue;
      throw std::invalid_argument(name_of(i) + " and " + name_of(k) + " overlap where they start.");
    }
  }
}

void Fleet::each(const std::function<void(std::size_t)>& call) const {
  if (for_each_) return for_each_(size(), call);
  for (std::size_t k = 0; k < size(); ++k) call(k);
}

void Fleet::restart() {
  each([this](std::size_t k) { worlds_[k]->restart(); });
  meet();
}

void Fleet::advance() {
  each([this](std::size_t k) { worlds_[k]->advance(); });
  meet();
}

/// Passes every robot the poses of the others.
void Fleet::meet() {
  for (std::size_t k = 0; k < size(); ++k) peers_[k].pose_W = worlds_[k]->pose_W();
  each([this](std::size_t k) { worlds_[k]->meet(peers_, k); });
  for (const auto& world : worlds_) {
    if (const auto other = world->touched()) worlds_[*other]->touch();
  }
}

std::optional<std::string> Fleet::edit(const algo::Request& request) {
  if (const auto robot = robot_in(request)) {
    if (*robot < size()) return name_of(*robot) + " moves by itself.";
    return "There is no robot " + std::to_string(*robot + 1) + ".";
  }
  for (std::size_t k = 0; k < size(); ++k) {
    auto problem = worlds_[k]->objection(request);
    if (problem && k > 0) problem = name_of(k) + ": " + *problem;
    if (problem) return problem;
  }
  for (const auto& world : worlds_) world->edit(request);
  return std::nullopt;
}

void Fleet::find_moved(algo::Recycled<algo::Moved>& moved) const {
  worlds_.front()->find_moved(moved);
  for (std::size_t k = 1; k < size(); ++k) moved.push_back({bodies_[k].id, peers_[k].pose_W});
}

std::vector<algo::Obstacle> other_robots(const Scenario& scenario) {
  std::vector<algo::Obstacle> bodies;
  for (std::size_t k = 1; k <= scenario.robots.size(); ++k) bodies.push_back(body_of(scenario, k));
  return bodies;
}

}  // namespace sim
