// algo/mapping/submap.cpp: packs the walls and the free space of a map.
#include "algo/mapping/submap.hpp"

#include <unordered_set>
#include <utility>

#include "algo/mapping/scan_matcher.hpp"

namespace algo {
namespace {

constexpr std::uint16_t kSurePasses = 2;  // beams through a cell that make it free
constexpr int kFreeCells = 10;            // of a block of 16
constexpr double kAlongWall = 0.2;        // [m] neighbours that tell a wall's normal

}  // namespace

Submap::Submap(const OccupancyMap& map) {
  keep_walls(map);
  keep_free(map);
}

void Submap::keep_walls(const OccupancyMap& map) {
  std::vector<Vec2> walls;
  std::vector<Side> sides;
  Vec2 low(0, 0);
  Vec2 high(0, 0);
  map.each_cell([&](const OccupancyMap::Index& cell, const OccupancyMap::Tally& tally) {
    if (!tally.occupied()) return;
    const Vec2 p = map.mean_W(cell, tally);
    low = walls.empty() ? p : low.cwiseMin(p).eval();
    high = walls.empty() ? p : high.cwiseMax(p).eval();
    walls.push_back(p);
    sides.push_back({tally.normal_x, tally.normal_y});
  });
  corner_ = low;
  columns_ = bin(high.x() - low.x()) + 1;
  rows_ = bin(high.y() - low.y()) + 1;
  first_.assign(at(columns_ - 1, rows_ - 1) + 2, 0);
  for (const Vec2& p : walls) ++first_[at(column(p.x()), row(p.y())) + 1];
  for (std::size_t k = 1; k < first_.size(); ++k) first_[k] += first_[k - 1];
  walls_.resize(walls.size());
  sides_.resize(walls.size());
  std::vector<std::uint32_t> next = first_;
  for (std::size_t k = 0; k < walls.size(); ++k) {
    const Vec2& p = walls[k];
    const std::uint32_t place = next[at(column(p.x()), row(p.y()))]++;
    walls_[place] = p.cast<float>();
    sides_[place] = sides[k];
    centre_ += p / static_cast<double>(walls.size());
  }
  find_normals();
}

/// The line through a wall's neighbours gives its normal, and the beams tell the side.
void Submap::find_normals() {
  std::vector<Side> found(sides_.size());
  for (std::size_t k = 0; k < walls_.size(); ++k) {
    const Facing seen = facing_of(k);
    if (seen.side.norm() < 0.5) continue;  // from both sides
    const Vec2 p = walls_[k].cast<double>();
    SurfaceFit fit;
    each_place_near(p, kAlongWall, [&](std::size_t other) {
      if (seen.side.dot(facing_of(other).side) <= 0) return;
      const Vec2 point = walls_[other].cast<double>();
      const double near = 1 - (point - p).squaredNorm() / (kAlongWall * kAlongWall);
      if (near > 0) fit.add(point, near);
    });
    const auto line = fit.line();
    const Vec2 unit = line ? line->normal_W : seen.side.normalized();
    const Vec2 side = (unit.dot(seen.side) < 0 ? -Side::kUnit : Side::kUnit) * unit;
    found[k] = {static_cast<std::int8_t>(std::lround(side.x())),
                static_cast<std::int8_t>(std::lround(side.y())),
                line.has_value()};
  }
  sides_ = std::move(found);
}

void Submap::keep_free(const OccupancyMap& map) {
  block_ = kBlock * map.cell_edge();
  const auto tiles = map.tiles();
  if (tiles.empty()) return;
  constexpr int kPerTile = OccupancyMap::kTileSide / kBlock;
  OccupancyMap::Index high = tiles.front();
  low_ = tiles.front();
  for (const auto& tile : tiles) {
    low_ = {std::min(low_.i, tile.i), std::min(low_.j, tile.j)};
    high = {std::max(high.i, tile.i), std::max(high.j, tile.j)};
  }
  free_columns_ = (high.i - low_.i + 1) * kPerTile;
  free_rows_ = (high.j - low_.j + 1) * kPerTile;
  low_ = {low_.i * kPerTile, low_.j * kPerTile};
  std::vector<std::uint8_t> seen(static_cast<std::size_t>(free_columns_ * free_rows_), 0);
  map.each_cell([&](const OccupancyMap::Index& cell, const OccupancyMap::Tally& tally) {
    if (tally.passes < kSurePasses || tally.occupied()) return;
    const int column = (cell.i - low_.i * kBlock) / kBlock;
    const int row = (cell.j - low_.j * kBlock) / kBlock;
    ++seen[cell_index(column, row, free_columns_)];
  });
  free_.resize(seen.size());
  for (std::size_t k = 0; k < seen.size(); ++k) free_[k] = seen[k] >= kFreeCells;
}

bool Submap::is_free(const Vec2& p) const {
  const int column = whole_below(p.x() / block_) - low_.i;
  const int row = whole_below(p.y() / block_) - low_.j;
  if (column < 0 || row < 0 || column >= free_columns_ || row >= free_rows_) return false;
  return free_[cell_index(column, row, free_columns_)];
}

bool Submap::wall_within(const Vec2& p, double reach) const {
  return wall_within(p, Facing{}, reach);
}

bool Submap::wall_within(const Vec2& p, const Facing& facing, double reach) const {
  bool met = false;
  each_facing(p, facing, reach, [&](const Vec2&) { met = true; });
  return met;
}

FacedPoints Submap::thinned(double spacing) const {
  FacedPoints kept;
  std::unordered_set<std::int64_t> taken;
  for (std::size_t k = 0; k < walls_.size(); ++k) {
    const Vec2 p = walls_[k].cast<double>();
    const auto i = static_cast<std::int64_t>(std::floor(p.x() / spacing));
    const auto j = static_cast<std::int64_t>(std::floor(p.y() / spacing));
    if (!taken.insert(i * (std::int64_t{1} << 32) + j).second) continue;
    kept.points.push_back(p);
    kept.facings.push_back(facing_of(k));
  }
  return kept;
}

std::size_t Submap::bytes() const {
  return walls_.size() * (sizeof(walls_[0]) + sizeof(sides_[0])) +
         first_.size() * sizeof(first_[0]) + free_.size() / 8;
}

}  // namespace algo
