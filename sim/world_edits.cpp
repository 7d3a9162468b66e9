// sim/world_edits.cpp: adds, moves and removes obstacles while the world runs.
#include <variant>

#include <fmt/format.h>

#include "sim/world.hpp"

namespace sim {
namespace {

std::string metres(double value) {
  return fmt::format("{:.2f} m", value);
}

std::string name_of(const algo::Obstacle& obstacle) {
  return fmt::format("Obstacle {}", obstacle.id);
}

std::string there_is_none(std::uint32_t id) {
  return fmt::format("There is no obstacle {}.", id);
}

}  // namespace

std::optional<std::string> World::edit(const algo::Request& request) {
  used_ = true;
  if (auto problem = objection(request)) return problem;
  if (const auto* add = std::get_if<algo::AddObstacle>(&request)) {
    insert(add->obstacle);
  } else if (const auto* change = std::get_if<algo::ChangeObstacle>(&request)) {
    remove(change->obstacle.id);
    insert(change->obstacle);
  } else if (const auto* move = std::get_if<algo::MoveObstacle>(&request)) {
    place(*obstacles_.find(move->id), move->pose_W);
  } else if (const auto* remove_request = std::get_if<algo::RemoveObstacle>(&request)) {
    remove(remove_request->id);
  }
  return std::nullopt;
}

std::optional<std::string> World::objection(const algo::Request& request) const {
  if (const auto* add = std::get_if<algo::AddObstacle>(&request)) {
    const std::uint32_t id = add->obstacle.id;
    if (obstacles_.find(id)) return "There is an obstacle " + std::to_string(id) + " already.";
    return refusal(add->obstacle);
  }
  if (const auto* change = std::get_if<algo::ChangeObstacle>(&request)) {
    const std::uint32_t id = change->obstacle.id;
    return obstacles_.find(id) ? refusal(change->obstacle) : there_is_none(id);
  }
  if (const auto* move = std::get_if<algo::MoveObstacle>(&request)) return objection(*move);
  const auto* gone = std::get_if<algo::RemoveObstacle>(&request);
  if (gone != nullptr && !obstacles_.find(gone->id)) return there_is_none(gone->id);
  return std::nullopt;
}

/// Why `obstacle` cannot stand at its pose.
std::optional<std::string> World::refusal(const algo::Obstacle& obstacle) const {
  if (const auto problem = algo::defect(obstacle)) {
    return name_of(obstacle) + ": " + *problem + ".";
  }
  ObstacleSet alone;
  alone.add(obstacle);
  const double distance = alone.clearance(hull_, vehicle_->state().pose_W);
  if (distance < 0) {
    return name_of(obstacle) + " would overlap the robot: " + metres(-distance) + " too close.";
  }
  return std::nullopt;
}

std::optional<std::string> World::objection(const algo::MoveObstacle& move) const {
  const auto index = obstacles_.find(move.id);
  if (!index) return there_is_none(move.id);
  algo::Obstacle obstacle = obstacles_[*index];
  obstacle.pose_W = move.pose_W;
  if (auto problem = refusal(obstacle)) return problem;
  if (obstacle.path) return name_of(obstacle) + " moves by itself.";
  return std::nullopt;
}

void World::insert(const algo::Obstacle& obstacle) {
  obstacles_.add(obstacle);
  if (obstacle.path) movers_.push_back(obstacle.id);
  vehicle_->added(obstacle);
  for (const auto& sensor : sensors_) sensor->add(obstacle);
}

void World::place(std::size_t index, const algo::Pose2& pose_W) {
  obstacles_.move(index, pose_W);
  vehicle_->moved(index, obstacles_[index]);
  show(obstacles_[index].id, pose_W);
}

/// Moves obstacle `id` for the sensors.
void World::show(std::uint32_t id, const algo::Pose2& pose_W) {
  for (const auto& sensor : sensors_) sensor->move(id, pose_W);
}

void World::remove(std::uint32_t id) {
  const std::size_t index = *obstacles_.find(id);
  obstacles_.remove(index);
  std::erase(movers_, id);
  vehicle_->removed(index);
  for (const auto& sensor : sensors_) sensor->remove(id);
  find_slots();
}

}  // namespace sim
