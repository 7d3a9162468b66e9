// algo/full_strip/node_strip.cpp: spacing, forces, breaks.
#include "algo/full_strip/node_strip.hpp"

#include <algorithm>

#include "algo/strip/strip.hpp"

namespace algo {
namespace {

constexpr double kShare = 0.15;  // share of a force per sweep: 0.5 overshoots, and the robot sways
constexpr double kMostPush = 0.06;    // [m] in one sweep
constexpr double kNearReach = 4.5;    // [m] of the strip that every sweep moves
constexpr double kHit = 0.05;         // [m] from a surface where a march ends
constexpr double kNarrow = 0.08;      // [m] more than the least clearance: centred on the hits
constexpr std::size_t kCentred = 12;  // nodes that may be

/// [m] Free distance from `p_W` along the unit vector `along`, up to `most`.
double march(const LocalMap& map, const Vec2& p_W, const Vec2& along, double most) {
  double way = 0;
  for (int k = 0; k < 12 && way < most; ++k) {
    const double d = map.distance(p_W + way * along);
    if (d < kHit) break;
    way += d;
  }
  return std::min(way, most);
}

}  // namespace

NodeStrip::NodeStrip() {
  nodes_.reserve(kMost);
  line_.reserve(kMost);
}

void NodeStrip::lay(const Recycled<Vec2>& path) {
  line_ = path;
  space_out();
}

/// Places nodes every kSpacing along `line_`.
void NodeStrip::space_out() {
  nodes_.clear();
  if (line_.empty()) return;
  nodes_.push_back({line_[0], {0, 0}, {0, 0}});
  double left = kSpacing;  // [m] to the next node
  for (std::size_t i = 1; i < line_.size() && nodes_.size() + 1 < kMost; ++i) {
    const Vec2 way = line_[i] - line_[i - 1];
    const double length = way.norm();
    double done = 0;
    while (length - done >= left && nodes_.size() + 1 < kMost) {
      done += left;
      nodes_.push_back({line_[i - 1] + way * (done / length), {0, 0}, {0, 0}});
      left = kSpacing;
    }
    left -= length - done;
  }
  const Vec2 end = line_.back();
  const bool close = nodes_.size() > 1 && (nodes_.back().position_W - end).norm() < kSpacing / 2;
  if (close) {
    nodes_.back().position_W = end;
  } else {
    nodes_.push_back({end, {0, 0}, {0, 0}});
  }
}

void NodeStrip::follow(const Vec2& robot_W) {
  if (empty()) return;
  // The nearest piece within the first metres: the strip may pass the robot again later on.
  std::size_t first = 1;
  double best = 1e18;
  double way = 0;
  for (std::size_t i = 1; i < nodes_.size() && way < 2.0; ++i) {
    const Vec2& a = nodes_[i - 1].position_W;
    const Vec2 edge = nodes_[i].position_W - a;
    way += edge.norm();
    const double t =
        std::clamp(edge.dot(robot_W - a) / std::max(1e-9, edge.squaredNorm()), 0.0, 1.0);
    const double far = (a + t * edge - robot_W).squaredNorm();
    if (far < best - 1e-9) {
      best = far;
      first = i;
    }
  }
  line_.clear();
  line_.push_back(robot_W);
  for (std::size_t i = first; i < nodes_.size(); ++i) line_.push_back(nodes_[i].position_W);
  space_out();
}

void NodeStrip::push(const LocalMap& map, const StripSettings& settings, std::size_t i) {
  Node& node = nodes_[i];
  const Vec2& before = nodes_[i - 1].position_W;
  const Vec2& after = nodes_[i + 1].position_W;
  node.internal_W = internal_force(before, node.position_W, after, settings.contraction);

  node.external_W = {0, 0};
  const Vec2 along = after - before;
  const double length = along.norm();
  const double d = map.distance(node.position_W);
  if (length > 1e-6 && d < settings.rest_distance) {
    const Vec2 tangent = along / length;
    const Vec2 left{-tangent.y(), tangent.x()};
    const double rest = settings.rest_distance;
    const double to_left = march(map, node.position_W, left, rest);
    const double to_right = march(map, node.position_W, -left, rest);
    // K_r (d_o - d) away from each side, and half as much away from the nearest obstacle of all.
    const double sides = to_left - to_right;
    const Vec2 nearest = map.gradient(node.position_W);
    const double gradient = 0.5 * (rest - d) * nearest.dot(left);
    node.external_W = settings.repulsion * (sides + gradient) * left;
  }
  Vec2 step = kShare * node.external_W;
  const double size = step.norm();
  if (size > kMostPush) step *= kMostPush / size;
  node.position_W += kShare * node.internal_W + step;
}

void NodeStrip::relax(const LocalMap& map, const StripSettings& settings, int sweeps) {
  if (nodes_.size() < 3) return;
  const auto near = std::min(nodes_.size() - 1, static_cast<std::size_t>(kNearReach / kSpacing));
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    const std::size_t end = sweep % 5 == 0 ? nodes_.size() - 1 : near;
    for (std::size_t i = 1; i < end; ++i) push(map, settings, i);
  }
}

void NodeStrip::centre(const LocalMap& map, const StripSettings& settings) {
  const std::size_t end = std::min(nodes_.size(), kCentred + 2);
  for (std::size_t i = 1; i + 1 < end; ++i) centre(map, settings.least_clearance + kNarrow, i);
}

/// Moves node `i` across the strip to the middle between the nearest hits on its two sides, if both
/// are nearer than `room` [m].
void NodeStrip::centre(const LocalMap& map, double room, std::size_t i) {
  const Vec2 along = nodes_[i + 1].position_W - nodes_[i - 1].position_W;
  Vec2& p_W = nodes_[i].position_W;
  if (along.squaredNorm() < 1e-6 || map.distance(p_W) > room) return;
  const Vec2 left = Vec2{-along.y(), along.x()} / along.norm();
  const double reach = room + kMostPush;
  double on_left = reach;
  double on_right = reach;
  map.each_near(p_W, reach, [&](const Vec2& hit_W) {
    const Vec2 way = hit_W - p_W;
    double& least = way.dot(left) > 0 ? on_left : on_right;
    least = std::min(least, way.norm());
  });
  if (std::max(on_left, on_right) >= reach) return;
  p_W += std::clamp((on_left - on_right) / 2, -kMostPush, kMostPush) * left;
}

double NodeStrip::broken_at(const LocalMap& map, const StripSettings& settings) const {
  constexpr std::size_t kStart = 2;  // the robot's own place is given
  for (std::size_t i = kStart; i < nodes_.size(); ++i) {
    if (map.distance(nodes_[i].position_W) < settings.least_clearance) {
      return static_cast<double>(i) * kSpacing;
    }
    // Two neighbours are far apart: an obstacle pushed in between.
    if ((nodes_[i].position_W - nodes_[i - 1].position_W).norm() > 4 * kSpacing) {
      return static_cast<double>(i) * kSpacing;
    }
  }
  return -1;
}

double NodeStrip::cost(const LocalMap& map, const StepCost& step) const {
  double sum = 0;
  for (std::size_t i = 1; i < nodes_.size(); ++i) {
    const Vec2& p = nodes_[i].position_W;
    sum += (p - nodes_[i - 1].position_W).norm() * step.of(map.distance(p));
  }
  return sum;
}

double NodeStrip::length() const {
  double sum = 0;
  for (std::size_t i = 1; i < nodes_.size(); ++i) {
    sum += (nodes_[i].position_W - nodes_[i - 1].position_W).norm();
  }
  return sum;
}

Vec2 NodeStrip::at(double s) const {
  for (std::size_t i = 1; i < nodes_.size(); ++i) {
    const Vec2& a = nodes_[i - 1].position_W;
    const Vec2 edge = nodes_[i].position_W - a;
    const double length = edge.norm();
    if (length > 0 && s <= length) return a + edge * (s / length);
    s -= length;
  }
  return nodes_.back().position_W;
}

}  // namespace algo
