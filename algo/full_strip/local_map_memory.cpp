// algo/full_strip/local_map_memory.cpp: what leaves the map's window, what enters it again, and the
// coarse layer for planning.
#include <algorithm>
#include <cmath>

#include "algo/full_strip/local_map.hpp"
#include "algo/full_strip/roomiest.hpp"

namespace algo {
namespace {

constexpr int kMapTiles = DistanceField::kTiles;  // along the window's edge
constexpr int kFinePerCoarse = BuildingMemory::kFineSide / BuildingMemory::kCoarseSide;
constexpr double kCm = 0.01;           // [m]
constexpr std::uint8_t kRestored = 6;  // hits of a cell that enters again

/// Calls `visit(column, row)` for each tile of a window of kMapTiles that lies outside the window
/// moved by (columns, rows).
template <typename Visit>
void each_outside(int columns, int rows, Visit&& visit) {
  for (int y = 0; y < kMapTiles; ++y) {
    for (int x = 0; x < kMapTiles; ++x) {
      const bool inside =
          x >= columns && x < columns + kMapTiles && y >= rows && y < rows + kMapTiles;
      if (!inside) visit(x, y);
    }
  }
}

}  // namespace

int LocalMap::tile_column() const {
  return static_cast<int>(std::lround(corner_W_.x() / BuildingMemory::kTileEdge));
}

int LocalMap::tile_row() const {
  return static_cast<int>(std::lround(corner_W_.y() / BuildingMemory::kTileEdge));
}

/// The window is about to move by (tile_columns, tile_rows).
void LocalMap::keep_leaving(int tile_columns, int tile_rows, BuildingMemory& memory) const {
  each_outside(tile_columns, tile_rows, [&](int x, int y) {
    memory.get(tile_column() + x, tile_row() + y).occupied.fill(0);
  });
  constexpr int kSide = BuildingMemory::kFineSide;
  for (const std::uint32_t cell : active_) {
    if (hits_[cell] < kOccupied) continue;
    const int column = static_cast<int>(cell) % kSize;
    const int row = static_cast<int>(cell) / kSize;
    const int x = column / kSide - tile_columns;
    const int y = row / kSide - tile_rows;
    if (x >= 0 && y >= 0 && x < kMapTiles && y < kMapTiles) continue;
    BuildingMemory::Tile& tile =
        memory.get(tile_column() + column / kSide, tile_row() + row / kSide);
    tile.occupied[static_cast<std::size_t>(row % kSide)] |= 1U << (column % kSide);
  }
}

/// The window has moved by (tile_columns, tile_rows).
void LocalMap::restore_entering(int tile_columns, int tile_rows, const BuildingMemory& memory) {
  each_outside(-tile_columns, -tile_rows, [&](int x, int y) {
    const BuildingMemory::Tile* const tile = memory.find(tile_column() + x, tile_row() + y);
    if (tile != nullptr) restore(x, y, *tile);
  });
}

void LocalMap::draw(const Vec2& centre_W, std::span<const Eigen::Vector2f> walls_W) {
  forget_cells(centre_W);
  for (const Eigen::Vector2f& wall_W : walls_W) {
    const Vec2 place = (wall_W.cast<double>() - corner_W_) / kCell;
    const int column = whole_below(place.x());
    const int row = whole_below(place.y());
    if (column < 0 || row < 0 || column >= kSize || row >= kSize) continue;
    const std::size_t cell = index(column, row);
    occupy(cell);
    const Vec2 off = kCell * (place - Vec2(column + 0.5, row + 0.5));
    means_[cell] = {static_cast<float>(off.x()), static_cast<float>(off.y())};
  }
}

std::vector<Vec2> LocalMap::windows_over(const BuildingMemory& memory) {
  constexpr int kCells = kInner * BuildingMemory::kCoarseSide;  // coarse, along the inner tiles
  const BuildingMemory::Cell low = memory.low();
  const BuildingMemory::Cell high = memory.high();
  std::vector<Vec2> middles_W;
  for (int row = low.row; row < high.row; row += kCells) {
    for (int column = low.column; column < high.column; column += kCells) {
      middles_W.emplace_back(BuildingMemory::kCoarse *
                             Vec2(column + kCells / 2.0, row + kCells / 2.0));
    }
  }
  return middles_W;
}

/// Occupies the cells of the window's tile (column, row). The means of their hits are lost.
void LocalMap::restore(int column, int row, const BuildingMemory::Tile& tile) {
  constexpr int kSide = BuildingMemory::kFineSide;
  for (int y = 0; y < kSide; ++y) {
    const std::uint32_t bits = tile.occupied[static_cast<std::size_t>(y)];
    for (int x = 0; bits != 0 && x < kSide; ++x) {
      if ((bits >> x & 1U) == 0) continue;
      const std::size_t cell = index(column * kSide + x, row * kSide + y);
      occupy(cell);
      means_[cell] = {};
    }
  }
}

/// Occupies a cell as if it had been hit often.
void LocalMap::occupy(std::size_t cell) {
  if (hits_[cell] == 0) active_.push_back(static_cast<std::uint32_t>(cell));
  hits_[cell] = std::max(hits_[cell], kRestored);
  seen_[cell] = now();
  if (field_) field_->occupy(static_cast<int>(cell) % kSize, static_cast<int>(cell) / kSize);
}

/// [m] The room for driving through the coarse cell that begins at the cell (column, row), along
/// either axis: on the narrowest of its two lines of the planner's points, the better one of each.
double LocalMap::room_through(int column, int row, double least, bool exact) const {
  static_assert(kFinePerCoarse == 4);
  const auto room = [&](int u, int v) {
    return room_at(*this, column + 2 * u, row + 2 * v, least, exact);
  };
  const double a = room(0, 0);
  const double b = room(1, 0);
  const double c = room(0, 1);
  const double d = room(1, 1);
  return std::max(std::min(std::max(a, b), std::max(c, d)),
                  std::min(std::max(a, c), std::max(b, d)));
}

/// True if neither the tile nor a neighbour has changed since its last survey: a hit changes
/// distances as far as DistanceField::kReach.
bool LocalMap::is_surveyed(int tile_x, int tile_y) const {
  static_assert(DistanceField::kReach < BuildingMemory::kTileEdge);
  std::uint32_t changed = 0;
  for (int y = tile_y - 1; y <= tile_y + 1; ++y) {
    for (int x = tile_x - 1; x <= tile_x + 1; ++x) {
      changed = std::max(changed, changed_[tile_index(x, y)]);
    }
  }
  return changed < surveyed_[tile_index(tile_x, tile_y)];
}

void LocalMap::survey(int tiles, double least, bool exact, BuildingMemory& memory) {
  constexpr int kSide = BuildingMemory::kFineSide;
  ++surveys_;
  for (int k = 0; k < tiles; ++k, next_survey_ = (next_survey_ + 1) % (kInner * kInner)) {
    const int x = 1 + next_survey_ % kInner;
    const int y = 1 + next_survey_ / kInner;
    if (is_surveyed(x, y)) continue;
    surveyed_[tile_index(x, y)] = surveys_;
    BuildingMemory::Tile& tile = memory.get(tile_column() + x, tile_row() + y);
    for (int row = 0; row < BuildingMemory::kCoarseSide; ++row) {
      for (int column = 0; column < BuildingMemory::kCoarseSide; ++column) {
        const double room = room_through(
            x * kSide + column * kFinePerCoarse, y * kSide + row * kFinePerCoarse, least, exact);
        // Rounded, but not across the least.
        const double cm = room < least ? std::min(room, least - kCm) / kCm : room / kCm + 1;
        tile.clearance[BuildingMemory::within({column, row})] = static_cast<std::uint8_t>(cm);
      }
    }
  }
}

}  // namespace algo
