// algo/mapping/occupancy_map.cpp: enters beams into cells.
#include "algo/mapping/occupancy_map.hpp"

#include <limits>

namespace algo {
namespace {

constexpr std::uint16_t kMost = std::numeric_limits<std::uint16_t>::max();
constexpr std::uint16_t kFresh = 64;  // hits after which a cell's mean becomes a slow average

}  // namespace

OccupancyMap::OccupancyMap(double cell, int side, const Vec2& centre_W) : cells_(cell, side) {
  cells_.centre_on(centre_W);
}

/// Counts a pass for all cells between the ends, except the cell in which the beam ends.
void OccupancyMap::pass(const Vec2& from_W, const Vec2& to_W) {
  const Cell end = cells_.cell_of(to_W);
  const Vec2 way = to_W - from_W;
  const int steps = static_cast<int>(std::ceil(way.norm() / cells_.edge()));
  Cell before = end;
  for (int k = 0; k < steps; ++k) {
    const Cell at = cells_.cell_of(from_W + way * (static_cast<double>(k) / steps));
    if (at == before || at == end || !cells_.covers(at)) continue;
    before = at;
    Tally& tally = cells_[at];
    if (tally.passes < kMost) ++tally.passes;
  }
}

void OccupancyMap::hit(const Vec2& point_W) {
  const Cell at = cells_.cell_of(point_W);
  if (!cells_.covers(at)) return;
  Tally& tally = cells_[at];
  if (tally.hits < kMost) ++tally.hits;
  const Vec2 off = point_W - cells_.centre(at);
  const float share = 1.0F / static_cast<float>(std::min(tally.hits, kFresh));
  tally.x += share * (static_cast<float>(off.x()) - tally.x);
  tally.y += share * (static_cast<float>(off.y()) - tally.y);
}

void OccupancyMap::insert(const LaserScan& scan, const Pose2& sensor_W, double reach) {
  const Vec2 from_W = sensor_W.position();
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (scan.status[i] != Beam::Ok) continue;
    const double range = std::min(scan.ranges[i], reach);
    const Vec2 to_W = from_W + range * direction(sensor_W.heading + scan.angle(i));
    pass(from_W, to_W);
    if (scan.ranges[i] <= reach) hit(to_W);
  }
}

}  // namespace algo
