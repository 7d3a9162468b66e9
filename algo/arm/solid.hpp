// algo/arm/solid.hpp: what an arm may touch, in three dimensions: upright pieces with a bottom and
// a top.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "algo/obstacle.hpp"
#include "algo/types.hpp"

namespace algo {

/// A rectangle with rounded corners on the map, from `bottom` to `top` above the floor. A disc has
/// no sides and its radius as rounding.
struct Solid {
  Vec2 centre_W = Vec2::Zero();
  Vec2 axis_W = Vec2::UnitX();  // of length 1, along half.x
  Vec2 half = Vec2::Zero();     // [m] half lengths of the sides before rounding
  double rounding = 0;          // [m] added all round
  double bottom = 0;            // [m] above the floor
  double top = std::numeric_limits<double>::infinity();  // [m]
  Vec2 velocity_W = Vec2::Zero();                        // [m/s]
  bool foreseen = false;  // nothing is there yet: see keep_ahead_free()

  /// Where it will be `seconds` from now.
  Solid after(double seconds) const {
    Solid moved = *this;
    moved.centre_W += seconds * velocity_W;
    return moved;
  }
};

/// Distance [m] from a point to the nearest surface, negative inside, and the unit vector along
/// which it grows. Convex, as the solid is.
struct SolidDistance {
  double distance = 0;
  Vec3 away = Vec3::UnitX();
};
SolidDistance distance_to(const Solid& solid, const Vec3& p_W);

/// The point of a straight link that is nearest to a solid.
struct NearestOnLink {
  double along = 0;     // 0 at the link's beginning, 1 at its end
  double distance = 0;  // [m] from the link's axis to the surface, negative inside
  Vec3 point_W = Vec3::Zero();
  Vec3 away = Vec3::UnitX();  // unit vector from the solid
};
NearestOnLink nearest_on_link(const Vec3& from_W, const Vec3& to_W, const Solid& solid);

/// Where a body that drives along `ahead` (of length 1) must not reach while it passes `solid`: the
/// solid drawn out along the way, and outwards from the side on which the shoulder passes it. An
/// arm that reaches beyond it there would touch it.
Solid solid_shadow(const Solid& solid, const Vec2& ahead, const Vec2& shoulder_W);

/// [m] Along `ahead`, between a link and `solid`; negative where they are side by side.
double gap_along(const Vec3& from_W, const Vec3& to_W, const Solid& solid, const Vec2& ahead);

/// Appends where each solid that moves will be within the next 2 s, and where it would be if it
/// turned back, as solids that stand. A base that has stopped in somebody's way gets out of it
/// late.
void keep_ahead_free(std::vector<Solid>& solids);

/// Appends what `obstacle` occupies from its bottom to its height; a polygon as its edges. Ramps
/// and trenches are ground and add nothing.
void append_solids(const Obstacle& obstacle, std::vector<Solid>& solids);

}  // namespace algo
