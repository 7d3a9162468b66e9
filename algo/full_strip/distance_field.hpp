// algo/full_strip/distance_field.hpp: how far it is from each cell of a square window to the
// nearest occupied one.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace algo {

/// A square of `size` x `size` cells moved by (columns, rows) down and left; what comes in is
/// `fresh`.
template <typename T>
void move_cells(std::vector<T>& cells, int size, int columns, int rows, T fresh) {
  const int x0 = std::max(0, -columns);
  const int x1 = std::min(size, size - columns);
  // In the order in which no row is overwritten before it has been moved.
  for (int k = 0; k < size; ++k) {
    const int y = rows >= 0 ? k : size - 1 - k;
    T* const to = &cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(size)];
    const int from = y + rows;
    if (from < 0 || from >= size || x1 <= x0) {
      std::fill_n(to, size, fresh);
      continue;
    }
    const T* const row = &cells[static_cast<std::size_t>(from) * static_cast<std::size_t>(size)];
    std::memmove(to + x0, row + x0 + columns, static_cast<std::size_t>(x1 - x0) * sizeof(T));
    std::fill(to, to + x0, fresh);
    std::fill(to + x1, to + size, fresh);
  }
}

/// Distances between cell centres, known up to kReach. A cell that becomes occupied lowers those
/// around it at once. One that becomes free leaves them too low, which is safe, until their tiles
/// have been rebuilt, a few each tick. Everything is allocated in the constructor.
class DistanceField {
 public:
  static constexpr double kCell = 0.05;  // [m]
  static constexpr int kSize = 512;      // cells along an edge
  static constexpr int kTile = 32;       // cells along a tile's edge
  /// [m] A little more than the circle of 1 m that the papers keep free: what pushes away from an
  /// obstacle must end outside of it.
  static constexpr double kReach = 1.02;

  DistanceField();

  /// Nothing is occupied.
  void reset();
  void occupy(int column, int row);
  void free(int column, int row);
  /// Rebuilds the tiles that wait for it longest. A cell counts as occupied when its `hits` are at
  /// least `occupied`.
  void rebuild(std::span<const std::uint8_t> hits, std::uint8_t occupied);
  /// Moves the window by whole tiles; what comes in is far from everything.
  void shift(int tile_columns, int tile_rows);

  /// [mm] Of a cell inside the window.
  std::int16_t at(int column, int row) const { return field_[index(column, row)]; }
  /// Of a cell of the window, row by row.
  static std::size_t index(int column, int row) {
    return static_cast<std::size_t>(row) * kSize + static_cast<std::size_t>(column);
  }
  /// The distances [mm] of (column, row) and the cells right of it; the next row is kSize further.
  const std::int16_t* from(int column, int row) const { return &field_[index(column, row)]; }

 private:
  static constexpr int kRadius = 21;                      // cells: kReach
  static constexpr std::size_t kWidth = 2 * kRadius + 1;  // of what a cell lowers
  static constexpr int kTiles = kSize / kTile;
  static constexpr int kSpan = kTile + 2 * kRadius;  // cells that a tile's distances depend on
  /// For each row of a tile, the cells up or down to the nearest occupied one in each column.
  using Gaps = std::array<std::array<std::uint8_t, kSpan>, kTile>;

  void measure_gaps(std::span<const std::uint8_t> hits,
                    std::uint8_t occupied,
                    int left,
                    int bottom);
  void rebuild_tile(int left, int bottom);

  std::vector<std::int16_t> field_;   // [mm]
  std::vector<std::int16_t> kernel_;  // [mm] around an occupied cell
  std::vector<int> reaches_;          // cells to either side that a row of it lowers, by its offset
  std::vector<std::int16_t> metric_;  // [mm] by the square of a distance in cells
  std::vector<std::uint8_t> soiled_;  // tiles whose distances are too short
  std::vector<std::uint16_t> tiles_;  // those, in the order they became so
  Gaps gaps_{};                       // workspace of rebuild()
};

}  // namespace algo
