// algo/mapping/occupancy_map.cpp: enters beams into cells.
#include "algo/mapping/occupancy_map.hpp"

#include <cmath>
#include <limits>
#include <tuple>
#include <type_traits>

namespace algo {
namespace {

constexpr std::uint16_t kMost = std::numeric_limits<std::uint16_t>::max();
constexpr std::uint16_t kFresh = 64;  // hits after which a cell's mean becomes a slow average
constexpr int kFreshNormals = 8;      // likewise of its normals

}  // namespace

OccupancyMap::Tally& OccupancyMap::open(const Index& cell) {
  const Index tile = tile_of(cell);
  if (last_tile_ == nullptr || !(tile == last_)) {
    std::unique_ptr<Tile>& place_of = tiles_[key(tile)];
    if (!place_of) place_of = std::make_unique<Tile>();
    last_ = tile;
    last_tile_ = place_of.get();
  }
  return (*last_tile_)[place(cell)];
}

/// Counts a pass for all cells between the ends, except the cell in which the beam ends.
void OccupancyMap::pass(const Vec2& from_W, const Vec2& to_W) {
  const Index end = cell_of(to_W);
  const Vec2 way = to_W - from_W;
  const int steps = static_cast<int>(std::ceil(way.norm() / edge_));
  Index before = end;
  for (int k = 0; k < steps; ++k) {
    const Index at = cell_of(from_W + way * (static_cast<double>(k) / steps));
    if (at == before || at == end) continue;
    before = at;
    Tally& tally = open(at);
    if (tally.passes < kMost) ++tally.passes;
    if (tally.hits == 0) tally.station = station_;
  }
}

bool OccupancyMap::sees(const Vec2& from_W, const Vec2& to_W) const {
  const Vec2 way = to_W - from_W;
  const int steps = static_cast<int>(std::ceil(2 * way.norm() / edge_));
  for (int k = 0; k < steps; ++k) {
    if (at(cell_of(from_W + way * (static_cast<double>(k) / steps))).occupied()) return false;
  }
  return true;
}

OccupancyMap::Tally& OccupancyMap::hit(const Vec2& point_W) {
  const Index at = cell_of(point_W);
  Tally& tally = open(at);
  if (tally.hits < kMost) ++tally.hits;
  tally.station = station_;
  const Vec2 off = point_W - centre(at);
  const float share = 1.0F / static_cast<float>(std::min(tally.hits, kFresh));
  tally.x += share * (static_cast<float>(off.x()) - tally.x);
  tally.y += share * (static_cast<float>(off.y()) - tally.y);
  return tally;
}

void OccupancyMap::face(Tally& tally, const Vec2& normal_W) {
  const double share = 1.0 / std::min<int>(tally.hits, kFreshNormals);
  const auto mean = [&](std::int8_t old, double value) {
    return static_cast<std::int8_t>(std::lround(old + share * (Tally::kUnit * value - old)));
  };
  tally.normal_x = mean(tally.normal_x, normal_W.x());
  tally.normal_y = mean(tally.normal_y, normal_W.y());
}

Facing OccupancyMap::Tally::facing() const {
  constexpr int kSure = kUnit / 2;  // a shorter mean is of both sides
  const Vec2 mean(normal_x, normal_y);
  if (mean.squaredNorm() < kSure * kSure) return {};
  return {mean.normalized(), false};
}

void OccupancyMap::mark_free(const Vec2& p_W) {
  constexpr std::uint16_t kFreePasses = 4;
  open(cell_of(p_W)).passes = kFreePasses;
}

/// Adds the counts of `tally`, whose means are of this cell.
void OccupancyMap::add(const Index& cell, const Tally& tally) {
  const auto sum = [](std::uint16_t a, std::uint16_t b) {
    return static_cast<std::uint16_t>(std::min<int>(kMost, a + b));
  };
  Tally& mine = open(cell);
  mine.passes = sum(mine.passes, tally.passes);
  if (tally.hits > 0 || mine.hits == 0) mine.station = tally.station;
  if (tally.hits == 0) return;
  mine.hits = sum(mine.hits, tally.hits);
  const double share = std::min(1.0, static_cast<double>(tally.hits) / mine.hits);
  const auto meet = [&](auto& mean, auto other) {
    const double met = mean + share * (static_cast<double>(other) - mean);
    mean = static_cast<std::remove_reference_t<decltype(mean)>>(
        std::is_integral_v<decltype(other)> ? std::round(met) : met);
  };
  meet(mine.x, tally.x);
  meet(mine.y, tally.y);
  meet(mine.normal_x, tally.normal_x);
  meet(mine.normal_y, tally.normal_y);
}

void OccupancyMap::add(const OccupancyMap& other) {
  other.each_cell([&](const Index& cell, const Tally& tally) {
    if (tally.known()) add(cell, tally);
  });
}

void OccupancyMap::trace(const OccupancyMap& other, const Vec2& p_W, double reach) {
  other.each_tally_near(p_W, reach, [&](const Vec2& wall_W, const Tally& tally) {
    Tally once = tally;
    once.hits = 1;
    once.passes = 0;
    add(cell_of(wall_W), once);
  });
}

/// `tally`, its hits moved to `to_W` and turned.
OccupancyMap::Tally OccupancyMap::moved(const Tally& tally, const Vec2& to_W, double turn) const {
  const Vec2 off = to_W - centre(cell_of(to_W));
  const Vec2 normal = to_parent(Pose2{0, 0, turn}, Vec2(tally.normal_x, tally.normal_y));
  Tally out = tally;
  out.x = static_cast<float>(off.x());
  out.y = static_cast<float>(off.y());
  out.normal_x = static_cast<std::int8_t>(std::lround(normal.x()));
  out.normal_y = static_cast<std::int8_t>(std::lround(normal.y()));
  return out;
}

OccupancyMap OccupancyMap::moved(std::span<const StationMove> stations) const {
  OccupancyMap out(edge_);
  // The walls first: the beams that passed beside a wall must not take its cell.
  for (const bool walls : {true, false}) {
    each_cell([&](const Index& cell, const Tally& tally) {
      if (!tally.known() || (tally.hits > 0) != walls) return;
      const StationMove& move = stations[tally.station];
      const Vec2 to_W = move.moved(mean_W(cell, tally));
      const Index to = out.cell_of(to_W);
      if (walls || out.at(to).hits == 0) out.add(to, moved(tally, to_W, move.turn()));
    });
  }
  return out;
}

void OccupancyMap::insert(const LaserScan& scan, const Pose2& sensor_W, double reach) {
  const Vec2 from_W = sensor_W.position();
  FacedPoints seen_W;
  seen_W.take(scan, sensor_W, std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < seen_W.points.size(); ++i) {
    const Vec2 way = seen_W.points[i] - from_W;
    const double range = way.norm();
    if (range <= reach) {
      insert(from_W, seen_W.points[i], seen_W.facings[i]);
    } else {
      pass(from_W, from_W + way * (reach / range));
    }
  }
}

OccupancyMap::Tally OccupancyMap::at(const Index& cell) const {
  const Tile* tile = find(tile_of(cell));
  return tile == nullptr ? Tally{} : (*tile)[place(cell)];
}

std::vector<OccupancyMap::Index> OccupancyMap::tiles() const {
  std::vector<Index> found;
  found.reserve(tiles_.size());
  for (const auto& [at, tile] : tiles_) {
    found.push_back({static_cast<int>(static_cast<std::uint32_t>(at)),
                     static_cast<int>(static_cast<std::uint32_t>(at >> 32U))});
  }
  std::ranges::sort(found, {}, [](const Index& t) { return std::tuple(t.j, t.i); });
  return found;
}

}  // namespace algo
