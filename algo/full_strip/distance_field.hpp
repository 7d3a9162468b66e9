// algo/full_strip/distance_field.hpp: the distance from each cell of a square window to the nearest
// occupied cell.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace algo {

/// Moves a square of `size` x `size` cells by (columns, rows) down and left. New cells are `fresh`.
template <typename T>
void move_cells(std::vector<T>& cells, int size, int columns, int rows, T fresh) {
  const int x0 = std::max(0, -columns);
  const int x1 = std::min(size, size - columns);
  // This order moves every row before it is overwritten.
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

/// Distances between cell centres, known up to kReach. A cell that becomes occupied lowers the
/// distances around it at once. A cell that becomes free leaves them too low, which is safe, until
/// their tiles are rebuilt, a few each tick. Allocates in the constructor only.
class DistanceField {
 public:
  static constexpr double kCell = 0.05;  // [m]
  static constexpr int kSize = 512;      // cells along an edge
  static constexpr int kTile = 32;       // cells along a tile's edge
  static constexpr int kTiles = kSize / kTile;
  /// [m] A little more than the circle of 1 m that the papers keep free: an obstacle's push must
  /// end outside that circle.
  static constexpr double kReach = 1.02;

  DistanceField();

  /// Clears all occupied cells.
  void reset();
  void occupy(int column, int row);
  void free(int column, int row);
  /// Rebuilds the tiles that have waited longest. A cell is occupied if it has at least `occupied`
  /// `hits`.
  /// @return the tiles rebuilt, row-major, until the next call
  std::span<const std::uint16_t> rebuild(std::span<const std::uint8_t> hits, std::uint8_t occupied);
  /// Moves the window by whole tiles. New cells are farther than kReach from any obstacle, until
  /// the occupied cells for which beside_new() holds are entered again.
  void shift(int tile_columns, int tile_rows);
  /// Whether a cell of the window that has moved so is near enough to new cells to lower them.
  static bool beside_new(int column, int row, int tile_columns, int tile_rows) {
    const auto beside = [](int at, int moved) {
      return moved > 0 ? at >= kSize - moved - kRadius : moved < 0 && at < kRadius - moved;
    };
    return beside(column, tile_columns * kTile) || beside(row, tile_rows * kTile);
  }

  /// [mm] The distance of a cell inside the window.
  std::int16_t at(int column, int row) const { return field_[index(column, row)]; }
  /// The row-major index of a cell of the window.
  static std::size_t index(int column, int row) {
    return static_cast<std::size_t>(row) * kSize + static_cast<std::size_t>(column);
  }
  /// The distances [mm] of (column, row) and the cells right of it; the next row is kSize further
  /// on.
  const std::int16_t* from(int column, int row) const { return &field_[index(column, row)]; }

 private:
  static constexpr int kRadius = 21;  // cells: kReach
  static constexpr std::size_t kTilesATick = 8;
  static constexpr std::size_t kWidth = 2 * kRadius + 1;  // edge of the area that a cell lowers
  static constexpr int kSpan = kTile + 2 * kRadius;       // cells that a tile's distances depend on
  /// For each row of a tile, the cells up or down to the nearest occupied one in each column.
  using Gaps = std::array<std::array<std::uint8_t, kSpan>, kTile>;

  void measure_gaps(std::span<const std::uint8_t> hits,
                    std::uint8_t occupied,
                    int left,
                    int bottom);
  void rebuild_tile(int left, int bottom);

  std::vector<std::int16_t> field_;   // [mm]
  std::vector<std::int16_t> kernel_;  // [mm] around an occupied cell
  std::vector<int> reaches_;          // half width, in cells, of each row of kernel_, by row offset
  std::vector<std::int16_t> metric_;  // [mm] by the squared distance in cells
  std::vector<std::uint8_t> soiled_;  // marks tiles whose distances are too low
  std::vector<std::uint16_t> tiles_;  // the marked tiles, oldest first
  std::array<std::uint16_t, kTilesATick> rebuilt_{};
  Gaps gaps_{};  // workspace of rebuild()
};

}  // namespace algo
