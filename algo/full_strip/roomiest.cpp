// algo/full_strip/roomiest.cpp: the small steps away from the nearest hit.
#include "algo/full_strip/roomiest.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace algo {
namespace {

/// True if the distance `d` [m] at the corner grows towards one side and falls towards the other:
/// there is a thing on one side alone. In a gap it falls or grows towards both.
bool rises(const LocalMap& map, int column, int row, double d) {
  constexpr double kSlope = 0.03;  // [m] between neighbours
  constexpr std::array<std::array<int, 2>, 4> kWays{{{2, 0}, {0, 2}, {2, 2}, {2, -2}}};
  return std::ranges::any_of(kWays, [&](const std::array<int, 2>& way) {
    const double before = corner_distance(map, column - way[0], row - way[1]) - d;
    const double after = corner_distance(map, column + way[0], row + way[1]) - d;
    return std::min(before, after) < -kSlope && std::max(before, after) > kSlope;
  });
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

double corner_distance(const LocalMap& map, int column, int row) {
  constexpr double kQuarterMm = 0.00025;  // [m]
  const int sum = map.cell_distance(column, row) + map.cell_distance(column + 1, row) +
                  map.cell_distance(column, row + 1) + map.cell_distance(column + 1, row + 1);
  return sum * kQuarterMm;
}

double room_at(const LocalMap& map, int column, int row, double least, bool exact) {
  const double d = corner_distance(map, column, row);
  if (!exact || !is_doubtful(d, least)) return d;
  if (rises(map, column, row, d)) return d + kAside;
  const Vec2 corner_W = map.corner_W() + LocalMap::kCell * Vec2(column + 1, row + 1);
  return roomiest(map, corner_W, kAside, LocalMap::kReach).distance;
}

}  // namespace algo
