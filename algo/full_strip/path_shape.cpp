// algo/full_strip/path_shape.cpp: straight lines past lattice points.
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
