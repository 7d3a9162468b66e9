// server/lab/reproduce/triangulate.hpp: a polygon with a notch as convex parts.
#pragma once

#include <optional>
#include <vector>

#include "algo/types.hpp"

namespace server::reproduce {

/// The polygon itself when it is convex, else triangles that fill it (ear clipping). Vertices in
/// either order; the parts are counter-clockwise. Nothing when the outline crosses itself or has
/// no area.
std::optional<std::vector<std::vector<algo::Vec2>>> convex_parts(std::vector<algo::Vec2> outline);

}  // namespace server::reproduce
