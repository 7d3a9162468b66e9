// algo/mapping/submap.cpp: packs the walls and the free space of a map.
#include "algo/mapping/submap.hpp"

#include <limits>
#include <unordered_set>

namespace algo {
namespace {

constexpr std::uint16_t kSurePasses = 2;  // beams through a cell that make it free
constexpr int kFreeCells = 10;            // of a block of 16

}  // namespace

Submap::Submap(const OccupancyMap& map) {
  keep_walls(map);
  keep_free(map);
}

void Submap::keep_walls(const OccupancyMap& map) {
  std::vector<Vec2> walls;
  Vec2 low(0, 0);
  Vec2 high(0, 0);
  map.each_cell([&](const OccupancyMap::Index& cell, const OccupancyMap::Tally& tally) {
    if (!tally.occupied()) return;
    const Vec2 p = map.mean_W(cell, tally);
    low = walls.empty() ? p : low.cwiseMin(p).eval();
    high = walls.empty() ? p : high.cwiseMax(p).eval();
    walls.push_back(p);
  });
  corner_ = low;
  columns_ = bin(high.x() - low.x()) + 1;
  rows_ = bin(high.y() - low.y()) + 1;
  first_.assign(at(columns_ - 1, rows_ - 1) + 2, 0);
  for (const Vec2& p : walls) ++first_[at(column(p.x()), row(p.y())) + 1];
  for (std::size_t k = 1; k < first_.size(); ++k) first_[k] += first_[k - 1];
  walls_.resize(walls.size());
  std::vector<std::uint32_t> next = first_;
  for (const Vec2& p : walls) {
    walls_[next[at(column(p.x()), row(p.y()))]++] = p.cast<float>();
    centre_ += p / static_cast<double>(walls.size());
  }
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
  const int column = static_cast<int>(std::floor(p.x() / block_)) - low_.i;
  const int row = static_cast<int>(std::floor(p.y() / block_)) - low_.j;
  if (column < 0 || row < 0 || column >= free_columns_ || row >= free_rows_) return false;
  return free_[cell_index(column, row, free_columns_)];
}

bool Submap::wall_within(const Vec2& p, double reach) const {
  bool met = false;
  each_near(p, reach, [&](const Vec2&) { met = true; });
  return met;
}

std::vector<Vec2> Submap::thinned(double spacing) const {
  std::vector<Vec2> kept;
  std::unordered_set<std::int64_t> taken;
  for (const Eigen::Vector2f& wall : walls_) {
    const Vec2 p = wall.cast<double>();
    const auto i = static_cast<std::int64_t>(std::floor(p.x() / spacing));
    const auto j = static_cast<std::int64_t>(std::floor(p.y() / spacing));
    if (taken.insert(i * (std::int64_t{1} << 32) + j).second) kept.push_back(p);
  }
  return kept;
}

std::size_t Submap::bytes() const {
  return walls_.size() * sizeof(walls_[0]) + first_.size() * sizeof(first_[0]) + free_.size() / 8;
}

}  // namespace algo
