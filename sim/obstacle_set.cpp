// sim/obstacle_set.cpp: planar distances, after a test of the bounding circles.
#include "sim/obstacle_set.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace sim {
namespace {

/// True if a side of the counter-clockwise convex `outline` has all of `points` outside it.
bool side_separates(std::span<const algo::Vec2> outline, std::span<const algo::Vec2> points) {
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const algo::Vec2& a = outline[i];
    const algo::Vec2 edge = outline[(i + 1) % outline.size()] - a;
    if (std::ranges::all_of(points,
                            [&](const algo::Vec2& p) { return algo::cross(edge, p - a) < 0; })) {
      return true;
    }
  }
  return false;
}

/// [m] Distance between two convex outlines; -1 if they overlap.
double between(std::span<const algo::Vec2> one, std::span<const algo::Vec2> other) {
  if (!side_separates(one, other) && !side_separates(other, one)) return -1;
  double nearest = std::numeric_limits<double>::infinity();  // squared
  for (std::size_t i = 0; i < one.size(); ++i) {
    for (std::size_t k = 0; k < other.size(); ++k) {
      nearest = std::min({nearest,
                          algo::squared_distance(one[i], other[k], other[(k + 1) % other.size()]),
                          algo::squared_distance(other[k], one[i], one[(i + 1) % one.size()])});
    }
  }
  return std::sqrt(nearest);
}

}  // namespace

algo::Pose2 pose_at(const algo::Obstacle& mover, double now) {
  if (!mover.path->is_there(now)) return kAway;
  const algo::Vec2 at_W = mover.path->at(now);
  return {at_W.x(), at_W.y(), mover.pose_W.heading};
}

std::optional<std::size_t> ObstacleSet::find(std::uint32_t id) const {
  for (std::size_t i = 0; i < items_.size(); ++i) {
    if (items_[i].obstacle.id == id) return i;
  }
  return std::nullopt;
}

/// Updates outline and circle of `item` to its obstacle's pose.
void ObstacleSet::measure(Item& item) {
  item.centre_W = item.obstacle.pose_W.position();
  if (const auto* cylinder = std::get_if<algo::Cylinder>(&item.obstacle.shape)) {
    item.bound = cylinder->radius;
    return;
  }
  item.outline_W = algo::outline_W(item.obstacle);
  item.centre_W = algo::Vec2(0, 0);
  for (const algo::Vec2& p : item.outline_W) {
    item.centre_W += p / static_cast<double>(item.outline_W.size());
  }
  item.bound = 0;
  for (const algo::Vec2& p : item.outline_W) {
    item.bound = std::max(item.bound, (p - item.centre_W).norm());
  }
}

void ObstacleSet::add(const algo::Obstacle& obstacle) {
  const bool ground = algo::is_ground(obstacle);
  items_.push_back(
      {.obstacle = obstacle, .ground = ground, .passed = ground || obstacle.bottom > tall_});
  measure(items_.back());
  if (items_.back().ground) ++grounds_;
}

void ObstacleSet::move(std::size_t index, const algo::Pose2& pose_W) {
  Item& item = items_[index];
  item.obstacle.pose_W = pose_W;
  item.hidden = false;
  measure(item);
}

void ObstacleSet::remove(std::size_t index) {
  if (items_[index].ground) --grounds_;
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
    inside = inside && algo::cross(edge, to_p) >= 0;
    nearest = std::min(nearest, algo::squared_distance(p_W, *a, b));
    a = &b;
  }
  return inside ? -std::sqrt(nearest) : std::sqrt(nearest);
}

bool ObstacleSet::may_reach(std::size_t index, const algo::Vec2& p_W, double reach) const {
  const double sum = items_[index].bound + reach;
  return !items_[index].hidden && sum >= 0 &&
         (items_[index].centre_W - p_W).squaredNorm() <= sum * sum;
}

double ObstacleSet::distance(const algo::Vec2& p_W) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < items_.size(); ++i) {
    if (items_[i].hidden || items_[i].passed) continue;
    // No point of it is nearer than its circle. Inside a circle, every distance must be computed.
    if (nearest > 0 && !may_reach(i, p_W, nearest)) continue;
    nearest = std::min(nearest, distance(i, p_W));
  }
  return nearest;
}

double ObstacleSet::clearance(const Item& item, const Hull& hull, const algo::Pose2& pose_W) const {
  if (item.outline_W.empty()) {
    const algo::Vec2 centre_R = algo::to_child(pose_W, item.centre_W);
    return algo::to_rectangle(centre_R, hull.half_length, hull.half_width) - item.bound;
  }
  const double l = hull.half_length;
  const double w = hull.half_width;
  const std::array corners_W{algo::to_parent(pose_W, {l, w}),
                             algo::to_parent(pose_W, {-l, w}),
                             algo::to_parent(pose_W, {-l, -w}),
                             algo::to_parent(pose_W, {l, -w})};
  return between(corners_W, item.outline_W);
}

double ObstacleSet::clearance(std::size_t index,
                              const Hull& hull,
                              const algo::Pose2& pose_W) const {
  if (hull.is_disc()) return distance(index, pose_W.position()) - hull.radius;
  return clearance(items_[index], hull, pose_W);
}

double ObstacleSet::clearance(const Hull& hull, const algo::Pose2& pose_W) const {
  if (hull.is_disc()) return distance(pose_W.position()) - hull.radius;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < items_.size(); ++i) {
    if (items_[i].passed) continue;
    // No point of it is nearer than its circle is to the rectangle's circle.
    if (!may_reach(i, pose_W.position(), std::max(nearest, 0.0) + hull.radius)) continue;
    nearest = std::min(nearest, clearance(items_[i], hull, pose_W));
  }
  return nearest;
}

double ObstacleSet::ground_at(const algo::Vec2& p_W) const {
  double ramp = 0;
  double trench = 0;
  for (std::size_t i = 0; grounds_ > 0 && i < items_.size(); ++i) {
    if (!items_[i].ground || !may_reach(i, p_W, 0) || distance(i, p_W) > 0) continue;
    const double top = algo::top_at(items_[i].obstacle, p_W);
    ramp = std::max(ramp, top);
    trench = std::min(trench, top);
  }
  return ramp > 0 ? ramp : trench;
}

}  // namespace sim
