// algo/full_strip/roomiest.hpp: clearances by the hits themselves, where those of the cells may
// err.
#pragma once

#include "algo/full_strip/local_map.hpp"
#include "algo/types.hpp"

namespace algo {

/// The place within `reach` [m] of `p_W` that is farthest from all hits, approached by small steps,
/// and its distance [m] to the nearest, at most `most`.
struct Roomiest {
  Vec2 p_W{0, 0};
  double distance = 0;
};
Roomiest roomiest(const LocalMap& map, const Vec2& p_W, double reach, double most);

/// [m] From a point of the planner's lattice to the roomiest place that it stands for.
inline constexpr double kAside = 0.06;

/// True if a distance `d` [m] between cells does not tell if there is a way for a robot that needs
/// `least` [m].
constexpr bool is_doubtful(double d, double least) {
  constexpr double kBelow = 0.06;  // [m]
  constexpr double kAbove = 0.02;  // [m]
  return d > least - kBelow && d < least + kAbove;
}

/// [m] Distance of the corner that the cell (column, row) shares with the three cells after it.
double corner_distance(const LocalMap& map, int column, int row);

/// [m] The room for a robot that needs `least` [m] at the same corner, a point of the planner's
/// lattice. With `exact` a doubtful distance is measured to the hits themselves where things are on
/// both sides. Beside a single thing there is more room next to it.
double room_at(const LocalMap& map, int column, int row, double least, bool exact);

}  // namespace algo
