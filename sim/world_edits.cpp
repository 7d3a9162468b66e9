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
    if (!obstacles_.find(id)) return there_is_none(id);
    if (auto problem = carried(id)) return problem;
    return refusal(change->obstacle);
  }
  if (const auto* move = std::get_if<algo::MoveObstacle>(&request)) return objection(*move);
  const auto* gone = std::get_if<algo::RemoveObstacle>(&request);
  if (gone == nullptr) return std::nullopt;
  return obstacles_.find(gone->id) ? carried(gone->id) : there_is_none(gone->id);
}

bool World::under_robot(const algo::Obstacle& obstacle) const {
  ObstacleSet alone;
  alone.add(obstacle);
  return alone.clearance(0, hull_, vehicle_->state().pose_W) < 0;
}

/// Why the ground `id` cannot be changed now: the robot stands on it.
std::optional<std::string> World::carried(std::uint32_t id) const {
  const algo::Obstacle& ground = obstacles_[*obstacles_.find(id)];
  if (!algo::is_ground(ground) || !under_robot(ground)) return std::nullopt;
  return name_of(ground) + " is under the robot.";
}

/// Why `obstacle` cannot stand at its pose.
std::optional<std::string> World::refusal(const algo::Obstacle& obstacle) const {
  if (const auto problem = algo::defect(obstacle)) {
    return name_of(obstacle) + ": " + *problem + ".";
  }
  if (obstacle.path && !obstacle.path->is_there(now())) return std::nullopt;
  if (algo::is_ground(obstacle)) {
    if (scenario_.physics == PhysicsKind::Kinematic) {
      return name_of(obstacle) + ": a ramp or trench needs physics bullet.";
    }
    // A robot may start on a ramp.
    if (starting_ || !under_robot(obstacle)) return std::nullopt;
    return name_of(obstacle) + " would be under the robot.";
  }
  ObstacleSet alone(robot_.hull_high);
  alone.add(obstacle);
  const double distance = alone.clearance(hull_, vehicle_->state().pose_W);
  if (distance < 0) {
    return name_of(obstacle) + " would overlap the robot: " + metres(-distance) + " too close.";
  }
  if (reach_ && reach_->nearest(vehicle_->state(), alone).distance < 0) {
    return name_of(obstacle) + " would overlap the robot's arm.";
  }
  return std::nullopt;
}

std::optional<std::string> World::objection(const algo::MoveObstacle& move) const {
  const auto index = obstacles_.find(move.id);
  if (!index) return there_is_none(move.id);
  if (auto problem = carried(move.id)) return problem;
  algo::Obstacle obstacle = obstacles_[*index];
  obstacle.pose_W = move.pose_W;
  if (auto problem = refusal(obstacle)) return problem;
  if (obstacle.path) return name_of(obstacle) + " moves by itself.";
  return std::nullopt;
}

void World::insert(const algo::Obstacle& obstacle) {
  obstacles_.add(obstacle);
  vehicle_->added(obstacle);
  for (const auto& sensor : sensors_) sensor->add(obstacle);
  if (solids_) {
    solids_->add(obstacle);
  } else if (algo::is_ground(obstacle)) {
    solids_ = std::make_unique<SolidCaster>();
    for (std::size_t k = 0; k < obstacles_.size(); ++k) solids_->add(obstacles_[k]);
    for (const Mover& mover : movers_) {
      if (!mover.there) solids_->move(mover.id, kAway);
    }
  }
  if (!obstacle.path) return;
  movers_.push_back({.id = obstacle.id, .index = obstacles_.size() - 1});
  if (!obstacle.path->is_there(now())) hide(movers_.back());
}

/// Takes `mover` away until its path brings it back.
void World::hide(Mover& mover) {
  obstacles_.hide(mover.index);
  vehicle_->moved(mover.index, obstacles_[mover.index]);
  show(mover.id, kAway);
  mover.there = false;
}

void World::place(std::size_t index, const algo::Pose2& pose_W) {
  obstacles_.move(index, pose_W);
  vehicle_->moved(index, obstacles_[index]);
  show(obstacles_[index].id, pose_W);
}

/// Moves obstacle `id` for the sensors.
void World::show(std::uint32_t id, const algo::Pose2& pose_W) {
  for (const auto& sensor : sensors_) sensor->move(id, pose_W);
  if (solids_) solids_->move(id, pose_W);
}

void World::remove(std::uint32_t id) {
  const std::size_t index = *obstacles_.find(id);
  obstacles_.remove(index);
  std::erase_if(movers_, [id](const Mover& mover) { return mover.id == id; });
  vehicle_->removed(index);
  for (const auto& sensor : sensors_) sensor->remove(id);
  if (solids_) solids_->remove(id);
  if (solids_ && !obstacles_.has_ground()) {
    solids_.reset();
    trail_->level();
  }
  find_indices();
}

}  // namespace sim
