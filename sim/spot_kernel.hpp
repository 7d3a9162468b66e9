// sim/spot_kernel.hpp: one reading from the rays across a laser spot.
#pragma once

#include <cstddef>
#include <cstdint>

namespace sim {

/// A scanner's rule for a spot that lies on an edge.
struct SpotRule {
  double jump = 0;               // [m] gap above which two rays hit two surfaces
  double mixed_gap = 0;          // [m] surfaces farther apart do not mix
  double near_share_to_win = 0;  // share of the spot for which the nearer surface is reported
  double range_max = 0;          // [m] reported without an echo
  std::uint32_t no_echo = 0;     // hits from this number on are not echoes
};

/// Rays per spot; the last is the beam itself.
constexpr std::size_t kSpotRays = 5;

/// Results of whole spots. `ranges` and `hits` have one row per ray, over all spots; the beams' own
/// row takes the results. A spot is split at the widest gap into a near and a far surface with the
/// shares f and 1 - f. Surfaces closer together than `mixed_gap` give f near + (1 - f) far, a value
/// in mid-air; else the nearer one is reported if its share is large enough.
void judge_spots(const SpotRule& rule, std::size_t spots, double* ranges, std::uint32_t* hits);

}  // namespace sim
