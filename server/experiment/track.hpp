// server/experiment/track.hpp: the path of a run in few points.
#pragma once

#include <span>
#include <vector>

#include "algo/types.hpp"

namespace server::experiment {

/// The first point, and each later one that lies at least `spacing` [m] from the one kept before.
std::vector<algo::Vec2> thinned(std::span<const algo::Vec2> track_W, double spacing);

/// At most some 400 points, at least 5 cm apart, and the last; rounded to centimetres.
std::vector<algo::Vec2> coarse(std::span<const algo::Vec2> track_W);

}  // namespace server::experiment
