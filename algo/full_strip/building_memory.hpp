// algo/full_strip/building_memory.hpp: what was seen beyond the local map: occupied cells, and a
// coarse layer for planning.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

#include "algo/full_strip/distance_field.hpp"
#include "algo/laser_scan.hpp"
#include "algo/map_move.hpp"
#include "algo/types.hpp"

namespace algo {

/// Tiles of the odometry frame W, each as large as one of the local map. They cover a square of
/// kEdge around the robot; a tile that is farther away may have been replaced by a nearer one.
/// Allocates in the constructor only, and a tile takes up memory once something of it was seen.
class BuildingMemory {
 public:
  static constexpr double kFine = DistanceField::kCell;   // [m] of an occupied cell
  static constexpr int kFineSide = DistanceField::kTile;  // of them along a tile's edge
  static constexpr double kCoarse = 0.2;                  // [m] of a cell for planning
  static constexpr int kCoarseSide = 8;                   // of them along a tile's edge
  static constexpr double kTileEdge = kFine * kFineSide;  // [m]
  static constexpr int kTiles = 128;                      // along the edge, a power of two
  static constexpr double kEdge = kTiles * kTileEdge;     // [m]
  static constexpr std::uint8_t kUnknown = 255;           // clearance of a cell

  static constexpr std::size_t kCells = std::size_t{kCoarseSide} * kCoarseSide;  // of a tile

  struct Tile {
    std::array<std::uint32_t, kFineSide> occupied{};  // a bit per cell, a number per row
    /// [cm] The room for driving through each coarse cell, or kUnknown.
    std::array<std::uint8_t, kCells> clearance{};
    std::array<std::uint8_t, kCells> seen{};  // beams that have crossed it
    std::array<std::uint8_t, kCells> doubts{};
    std::uint64_t near = 0;            // a bit per cell: a beam came here from within kNear
    std::uint64_t driven = 0;          // a bit per cell: the robot's centre was here
    std::int16_t column = 0, row = 0;  // its place: the plane's tiles share memory periodically
    bool used = false;
  };
  /// A coarse cell of W: (column, row) spans [column, column + 1) x [row, row + 1) times kCoarse.
  struct Cell {
    int column = 0, row = 0;
  };

  BuildingMemory();
  void reset();

  /// The tile (column, row) of W; nothing if nothing of it is known.
  const Tile* find(int column, int row) const {
    const Tile& tile = tiles_[place(column, row)];
    return tile.used && tile.column == column && tile.row == row ? &tile : nullptr;
  }
  /// The same, made if it is missing.
  Tile& get(int column, int row);

  /// Forgets all but where the robot has been, and remembers the map after the move. Clearances are
  /// not known until a survey.
  void draw(const MapMove& move);

  /// Marks the coarse cells that the beams of a scan from `sensor_W` cross, up to kLook. A beam
  /// does not cross the cell in which it ends; a mixed beam raises doubts there and around.
  void look(const LaserScan& scan, const Pose2& sensor_W);
  static constexpr double kLook = 8.0;  // [m]

  bool seen(Cell c) const { return crossings(c) > 0; }
  /// Beams that have crossed the cell, at most kMostCrossings.
  std::uint8_t crossings(Cell c) const {
    const Tile* const tile = find(tile_of(c.column), tile_of(c.row));
    return tile != nullptr ? tile->seen[within(c)] : std::uint8_t{0};
  }
  static constexpr std::uint8_t kMostCrossings = 255;
  /// True if something may stand there that no beam has shown well: its end was mixed, and no beam
  /// has crossed the place since.
  bool doubtful(Cell c) const {
    const Tile* const tile = find(tile_of(c.column), tile_of(c.row));
    return tile != nullptr && tile->doubts[within(c)] >= kDoubtful;
  }
  /// True if a beam has crossed the cell, or ended in it, within kNear of its scanner.
  bool seen_near(Cell c) const {
    const Tile* const tile = find(tile_of(c.column), tile_of(c.row));
    return tile != nullptr && (tile->near >> within(c) & 1U) != 0;
  }
  static constexpr double kNear = 2.5;  // [m]

  /// The robot's centre is at `here_W`.
  void drive(const Vec2& here_W) {
    const Cell c = cell_of(here_W);
    get(tile_of(c.column), tile_of(c.row)).driven |= std::uint64_t{1} << within(c);
  }
  bool driven(Cell c) const {
    const Tile* const tile = find(tile_of(c.column), tile_of(c.row));
    return tile != nullptr && (tile->driven >> within(c) & 1U) != 0;
  }
  /// [cm] or kUnknown.
  std::uint8_t clearance(Cell c) const {
    const Tile* const tile = find(tile_of(c.column), tile_of(c.row));
    return tile != nullptr ? tile->clearance[within(c)] : kUnknown;
  }

  static int tile_of(int coarse) { return coarse >> 3; }
  static std::size_t within(Cell c) {
    return static_cast<std::size_t>(c.row & (kCoarseSide - 1)) * kCoarseSide +
           static_cast<std::size_t>(c.column & (kCoarseSide - 1));
  }
  static Cell cell_of(const Vec2& p_W) {
    return {whole_below(p_W.x() / kCoarse), whole_below(p_W.y() / kCoarse)};
  }
  static Vec2 middle_W(Cell c) { return kCoarse * Vec2(c.column + 0.5, c.row + 0.5); }

  /// The corners of a rectangle, in coarse cells, that holds all that was seen.
  Cell low() const { return low_; }
  Cell high() const { return high_; }

 private:
  static constexpr std::uint8_t kDoubtful = 8;  // doubts of a cell
  void doubt(Cell c);
  std::vector<Vec2> driven_W() const;
  static std::size_t place(int column, int row) {
    constexpr auto kMask = static_cast<unsigned>(kTiles - 1);
    return (static_cast<unsigned>(row) & kMask) * static_cast<std::size_t>(kTiles) +
           (static_cast<unsigned>(column) & kMask);
  }
  struct Release {
    void operator()(void* memory) const { std::free(memory); }
  };

  std::unique_ptr<Tile[], Release> tiles_;  // zero until used
  Cell low_{}, high_{};
  bool empty_ = true;
  std::size_t looks_ = 0;
};

}  // namespace algo
