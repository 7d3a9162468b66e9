// algo/drawn_space.hpp: the room that a known map shows, cell by cell, for planners.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

namespace algo {

/// Square cells of the map's frame M, in which the robot drives: M is W. Cell (column, row) spans
/// [column, column + 1) x [row, row + 1) times kCell. A value that does not change during a run,
/// and may be shared.
class DrawnSpace {
 public:
  static constexpr double kCell = 0.2;           // [m]
  static constexpr std::uint8_t kUnknown = 255;  // clearance of a cell
  static constexpr std::uint8_t kMost = 100;     // [cm] larger clearances are not told apart

  /// An empty map.
  DrawnSpace() = default;
  /// `clearances` [cm] of columns x rows cells, by rows from the cell (left, bottom) on. Throws
  /// std::invalid_argument if their number is another one.
  DrawnSpace(int left, int bottom, int columns, int rows, std::vector<std::uint8_t> clearances)
      : left_(left),
        bottom_(bottom),
        columns_(columns),
        rows_(rows),
        cells_(std::move(clearances)) {
    const bool good =
        columns >= 0 && rows >= 0 &&
        cells_.size() == static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    if (!good) throw std::invalid_argument("The cells of a drawn space are not columns x rows.");
  }

  /// [cm] The largest distance to a drawn wall within the cell, at most kMost; kUnknown where the
  /// map shows nothing, and outside.
  std::uint8_t clearance(int column, int row) const {
    const int x = column - left_;
    const int y = row - bottom_;
    if (x < 0 || y < 0 || x >= columns_ || y >= rows_) return kUnknown;
    return cells_[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
                  static_cast<std::size_t>(x)];
  }

  int left() const { return left_; }
  int bottom() const { return bottom_; }
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  /// By rows.
  const std::vector<std::uint8_t>& cells() const { return cells_; }
  bool operator==(const DrawnSpace&) const = default;

 private:
  int left_ = 0, bottom_ = 0;
  int columns_ = 0, rows_ = 0;
  std::vector<std::uint8_t> cells_{};
};

}  // namespace algo
