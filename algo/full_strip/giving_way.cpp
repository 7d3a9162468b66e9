// algo/full_strip/giving_way.cpp: the search's carrot on the strip, and its state.
#include "algo/full_strip/giving_way.hpp"

#include <algorithm>
#include <cmath>

namespace algo {
namespace {

constexpr double kDrivesOn = 0.1;         // [m/s] faster is no giving way
constexpr std::size_t kCarrotStride = 4;  // nodes between two looks for the carrot

/// Steers for the farthest visible point of the strip.
void aim(SpaceTimeInput& search, const StageInput& stage, double half_width) {
  if (stage.strip->empty()) return;
  const Recycled<Node>& nodes = stage.strip->nodes();
  std::size_t carrot = 1;
  for (std::size_t i = kCarrotStride; i < nodes.size() + kCarrotStride - 1; i += kCarrotStride) {
    const std::size_t at = std::min(i, nodes.size() - 1);
    if (!stage.map->sees(nodes[0].position_W, nodes[at].position_W, half_width)) break;
    carrot = at;
  }
  search.carrot_W = nodes[carrot].position_W;
  search.beyond = static_cast<double>(nodes.size() - 1 - carrot) * NodeStrip::kSpacing;
}

}  // namespace

std::optional<StripCommand> GivingWay::next(const StageInput& stage,
                                            const HullCheck& hull,
                                            const Tracker& tracker,
                                            const ControlInput& in,
                                            double lead,
                                            Weighing& out) {
  SpaceTimeInput search;
  search.map = stage.map;
  search.hull = &hull;
  search.spec = in.spec;
  search.tracks = &tracker.moving();
  search.standing = &tracker.standing();
  search.lead = lead;
  search.stamp = in.stamp;
  search.state = stage.state;
  search.limits = stage.limits;
  search.looks_back = tracker.looks_back();
  if (!search_.needed(search, *stage.strip)) return std::nullopt;
  search.carrot_W = in.goal->position_W;
  aim(search, stage, hull.half_width());
  const Twist2 twist = search_.search(search, out);
  out.pass_W = search.carrot_W;
  Twist2 reached = advanced(stage.state, twist, stage.limits, in.dt).twist;
  // A base that lags behind its commands would brake too late if it were asked step by step.
  if (std::abs(twist.v) < std::abs(reached.v)) reached.v = twist.v;
  if (!search_.clear()) return StripCommand{reached, strip_state::kCornered, true};
  const bool drives_on = twist.v > kDrivesOn;
  return StripCommand{reached, drives_on ? strip_state::kFollowing : strip_state::kGivingWay, true};
}

}  // namespace algo
