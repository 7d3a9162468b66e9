// algo/full_strip/path_shape.cpp: small steps away from hits, and straight lines past lattice
// points.
#include <algorithm>
#include <cmath>

#include "algo/full_strip/planner.hpp"

namespace algo {
namespace {

/// True if the line leads past or through walls that only the map shows.
bool meets_drawn_wall(const PlanWorld& world, const Vec2& from_W, const Vec2& to_W, double least) {
  if (world.drawn == nullptr) return false;
  const int steps = static_cast<int>((to_W - from_W).norm() / LocalMap::kCell);
  for (int k = 0; k <= steps; ++k) {
    const auto cell = BuildingMemory::cell_of(from_W + (to_W - from_W) * k / std::max(1, steps));
    if (!world.memory.seen(cell) && world.drawn_room(cell).value_or(least) < least) return true;
  }
  return false;
}

}  // namespace

Roomiest roomiest(const LocalMap& map, const Vec2& p_W, double reach, double most) {
  constexpr double kStep = 0.02;   // [m]
  constexpr double kBeyond = 0.5;  // [m] nothing farther matters where it is narrow
  const double look = std::min(most, kBeyond);
  Vec2 nearest_W{0, 0};
  const auto measure = [&](const Vec2& at_W) {
    double least = look * look;
    nearest_W = at_W;
    map.each_near(at_W, look, [&](const Vec2& point_W) {
      const double far = (point_W - at_W).squaredNorm();
      if (far >= least) return;
      least = far;
      nearest_W = point_W;
    });
    return std::sqrt(least);
  };
  Roomiest best{p_W, measure(p_W)};
  for (double way = kStep; way <= reach && nearest_W != best.p_W; way += kStep) {
    const Vec2 away = (best.p_W - nearest_W).normalized();
    const Vec2 next_W = best.p_W + kStep * away;
    const double d = measure(next_W);
    if (d <= best.distance) break;
    best = {next_W, d};
  }
  return best;
}

void straighten(const PlanWorld& world, double room, double least, Recycled<Vec2>& path) {
  const LocalMap& map = world.map;
  const auto sees = [&](const Vec2& from_W, const Vec2& to_W) {
    return map.sees(from_W, to_W, room) && !meets_drawn_wall(world, from_W, to_W, least);
  };
  const std::size_t size = path.size();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < size;) {
    path[kept++] = path[i];
    std::size_t next = i + 1;
    if (map.distance(path[i]) >= room) {
      while (next + 1 < size && sees(path[i], path[next + 1])) ++next;
    }
    i = next;
  }
  while (path.size() > kept) path.pop_back();
}

}  // namespace algo
