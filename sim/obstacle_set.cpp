// sim/obstacle_set.cpp: planar distances with a circle test first.
#include "sim/obstacle_set.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sim {

std::optional<std::size_t> ObstacleSet::find(std::uint32_t id) const {
  for (std::size_t i = 0; i < items_.size(); ++i) {
    if (items_[i].obstacle.id == id) return i;
  }
  return std::nullopt;
}

ObstacleSet::Item ObstacleSet::make(const algo::Obstacle& obstacle) {
  Item item{.obstacle = obstacle,
            .centre_W = obstacle.pose_W.position(),
            .outline_W = algo::outline_W(obstacle)};
  if (const auto* cylinder = std::get_if<algo::Cylinder>(&obstacle.shape)) {
    item.bound = cylinder->radius;
    return item;
  }
  item.centre_W = algo::Vec2(0, 0);
  for (const algo::Vec2& p : item.outline_W) {
    item.centre_W += p / static_cast<double>(item.outline_W.size());
  }
  for (const algo::Vec2& p : item.outline_W) {
    item.bound = std::max(item.bound, (p - item.centre_W).norm());
  }
  return item;
}

void ObstacleSet::add(const algo::Obstacle& obstacle) {
  items_.push_back(make(obstacle));
}

void ObstacleSet::move(std::size_t index, const algo::Pose2& pose_W) {
  algo::Obstacle obstacle = items_[index].obstacle;
  obstacle.pose_W = pose_W;
  items_[index] = make(obstacle);
}

void ObstacleSet::remove(std::size_t index) {
  items_.erase(items_.begin() + static_cast<std::ptrdiff_t>(index));
}

double ObstacleSet::distance(std::size_t index, const algo::Vec2& p_W) const {
  const Item& item = items_[index];
  if (item.outline_W.empty()) return (p_W - item.centre_W).norm() - item.bound;
  double nearest = std::numeric_limits<double>::infinity();  // squared
  bool inside = true;
  const algo::Vec2* a = &item.outline_W.back();
  for (const algo::Vec2& b : item.outline_W) {
    const algo::Vec2 edge = b - *a;
    const algo::Vec2 to_p = p_W - *a;
    inside = inside && edge.x() * to_p.y() - edge.y() * to_p.x() >= 0;
    const double length_squared = edge.squaredNorm();
    const double along =
        length_squared > 0 ? std::clamp(edge.dot(to_p) / length_squared, 0.0, 1.0) : 0;
    nearest = std::min(nearest, (to_p - along * edge).squaredNorm());
    a = &b;
  }
  return inside ? -std::sqrt(nearest) : std::sqrt(nearest);
}

bool ObstacleSet::may_reach(std::size_t index, const algo::Vec2& p_W, double reach) const {
  const double sum = items_[index].bound + reach;
  return sum >= 0 && (items_[index].centre_W - p_W).squaredNorm() <= sum * sum;
}

double ObstacleSet::distance(const algo::Vec2& p_W) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < items_.size(); ++i) {
    // Nothing of it can be nearer than its circle; inside one, every distance must be looked at.
    if (nearest > 0 && !may_reach(i, p_W, nearest)) continue;
    nearest = std::min(nearest, distance(i, p_W));
  }
  return nearest;
}

}  // namespace sim
