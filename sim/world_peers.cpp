// sim/world_peers.cpp: the other robots from one robot's view.
#include <algorithm>
#include <cmath>

#include "sim/bullet_vehicle.hpp"
#include "sim/world.hpp"

namespace sim {
namespace {

constexpr double kSolid = BulletVehicle::kNear + 0.01;  // [m] beyond hull, body and a tick's travel

double size_of(const RobotModel& robot) {
  return std::max(robot.radius, std::hypot(robot.hull_length, robot.hull_width) / 2);
}

}  // namespace

algo::Obstacle robot_body(const RobotModel& robot, const algo::Pose2& pose_W) {
  algo::Obstacle body;
  body.pose_W = pose_W;
  body.height = std::max(robot.hull_high, robot.sensors.height());
  if (robot.round) {
    body.shape = algo::Cylinder{robot.radius};
  } else {
    body.shape = algo::Box{robot.hull_length, robot.hull_width};
  }
  return body;
}

/// [m] Distance from R to the farthest point that a sensor reaches within a tick, including the
/// distance travelled during its sweep.
double World::sight() const {
  double reach = 0;
  double memory = 0;  // [s]
  for (const LaserConfig& laser : robot_.sensors.lasers) {
    reach = std::max(reach, laser.range_max + laser.mount_R.position().norm());
    if (laser.rolling) memory = std::max(memory, 2 * laser.turns * laser.mirror_period);
  }
  if (robot_.sensors.sonar)
    reach = std::max(reach, robot_.sensors.sonar->range_max + robot_.radius);
  for (const InfraredConfig& scanner : robot_.sensors.infrared) {
    reach = std::max(reach, scanner.range_max + scanner.mount_R.position().norm());
  }
  const double way = robot_.max_v * (memory + scenario_.period);
  return std::max(reach, size_of(robot_) + kSolid) + way;
}

void World::meet(std::span<const Peer> robots, std::size_t self) {
  used_ = true;
  slot_of_.resize(robots.size(), kNoSlot);
  close_.clear();
  const algo::Vec2 here = vehicle_->state().pose_W.position();
  for (std::size_t k = 0; k < robots.size(); ++k) {
    if (k == self) continue;
    const Peer& robot = robots[k];
    const double reach = sight_ + robot.radius;
    std::size_t& slot = slot_of_[k];
    if ((robot.pose_W.position() - here).squaredNorm() < reach * reach) {
      if (slot == kNoSlot) slot = free_slot(*robot.body);
      place_peer(slot, robot.pose_W);
      if (slots_[slot].solid) close_.push_back(k);
    } else if (slot != kNoSlot) {
      hide_peer(slot);
      slot = kNoSlot;
    }
  }
  feel_peers();
}

/// A free slot with the shape of `robot`; made if there is none.
std::size_t World::free_slot(const algo::Obstacle& robot) {
  const auto fits = [&](const Slot& slot) {
    const algo::Obstacle& there = obstacles_[slot.index];
    return !slot.taken && there.height == robot.height && there.shape == robot.shape;
  };
  const auto found = std::ranges::find_if(slots_, fits);
  if (found != slots_.end()) {
    found->taken = true;
    return static_cast<std::size_t>(found - slots_.begin());
  }
  algo::Obstacle obstacle = robot;
  obstacle.id = kRobotIds + static_cast<std::uint32_t>(slots_.size());
  slots_.push_back({.id = obstacle.id, .index = obstacles_.size(), .taken = true, .solid = true});
  insert(obstacle);
  return slots_.size() - 1;
}

/// The vehicle knows only robots that it may touch within the next tick: moving a body makes it
/// check all of them.
void World::place_peer(std::size_t number, const algo::Pose2& pose_W) {
  Slot& slot = slots_[number];
  obstacles_.move(slot.index, pose_W);
  show(slot.id, pose_W);
  const double reach = robot_.radius + kSolid + robot_.max_v * scenario_.period;
  const bool solid = obstacles_.may_reach(slot.index, vehicle_->state().pose_W.position(), reach);
  if (solid || slot.solid) vehicle_->moved(slot.index, obstacles_[slot.index]);
  slot.solid = solid;
}

void World::hide_peer(std::size_t number) {
  Slot& slot = slots_[number];
  obstacles_.hide(slot.index);
  show(slot.id, kAway);
  if (slot.solid) vehicle_->moved(slot.index, obstacles_[slot.index]);
  slot.taken = false;
  slot.solid = false;
}

/// Updates the indices of obstacles after one was removed.
void World::find_indices() {
  for (Slot& slot : slots_) slot.index = *obstacles_.find(slot.id);
  for (Mover& mover : movers_) mover.index = *obstacles_.find(mover.id);
}

/// Checks whether another robot overlaps this one, and which robot a contact is with: the nearest.
void World::feel_peers() {
  bumped_ = false;
  touched_.reset();
  const algo::Pose2& pose_W = vehicle_->state().pose_W;
  const bool contact = vehicle_->state().contact;
  const double nearest = contact ? std::max(0.0, obstacles_.clearance(hull_, pose_W)) : 0;
  for (const std::size_t k : close_) {
    const double clearance = obstacles_.clearance(slots_[slot_of_[k]].index, hull_, pose_W);
    bumped_ = bumped_ || clearance < 0;
    if (contact && clearance <= nearest) touched_ = k;
  }
}

}  // namespace sim
