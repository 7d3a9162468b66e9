// sim/spot_kernel.hpp: one reading from the rays across a laser spot.
#pragma once

#include <cstddef>
#include <cstdint>

namespace sim {

/// What a scanner makes of a spot that lies on an edge.
struct SpotRule {
  double jump = 0;               // [m] gap above which two rays met two surfaces
  double mixed_gap = 0;          // [m] surfaces farther apart are not mixed
  double near_share_to_win = 0;  // of the spot, for the nearer surface to be reported
  double range_max = 0;          // [m] of what gives no echo
  std::uint32_t no_echo = 0;     // hits from this number on are none
};

/// Rays of a spot; the last one is the beam's own.
constexpr std::size_t kSpotRays = 5;

/// What whole spots give. `ranges` and `hits` have a row for each ray, with all spots in it; the
/// row of the beams' own takes the results. A spot is split at the widest gap into a near and a far
/// surface with the shares f and 1 - f. Surfaces closer together than `mixed_gap` give
/// f near + (1 - f) far, a value in mid-air; else the nearer one is reported if it has its share.
void judge_spots(const SpotRule& rule, std::size_t spots, double* ranges, std::uint32_t* hits);

}  // namespace sim
