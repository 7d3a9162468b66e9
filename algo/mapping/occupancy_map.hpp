// algo/mapping/occupancy_map.hpp: an occupancy map without limits. Each cell counts the beams that
// ended in it and that passed through it, and averages its returns.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "algo/laser_scan.hpp"
#include "algo/map_move.hpp"
#include "algo/mapping/facing.hpp"
#include "algo/types.hpp"

namespace algo {

/// Square tiles of cells, made when a beam first enters them: memory grows with the area seen.
///
/// A cell's occupancy is hits / (hits + passes): of the beams that reached it, the share that ended
/// there (counting model; Haehnel, Burgard, Thrun 2003).
class OccupancyMap {
 public:
  static constexpr int kTileSide = 64;  // [cells]

  struct Tally {
    float x = 0, y = 0;        // [m] mean of the hits, from the cell's centre
    std::uint16_t hits = 0;    // beams that ended here
    std::uint16_t passes = 0;  // beams that went through
    /// Mean of the unit normals that the hits came with, in 1 / kUnit.
    std::int8_t normal_x = 0, normal_y = 0;
    std::uint16_t station = 0;  // from which the newest beam came
    bool known() const { return hits > 0 || passes > 0; }
    /// Beams pass often through cells of walls seen at a slant, and far more often through those of
    /// things that left.
    bool occupied() const { return hits > 0 && 4 * hits >= passes; }
    static constexpr int kUnit = 100;
    /// The mean of the facings of the hits; nothing if they came from both sides.
    Facing facing() const;
  };
  /// Cell (i, j) spans [i edge, (i + 1) edge) x [j edge, (j + 1) edge) of W; likewise a tile.
  struct Index {
    int i = 0;
    int j = 0;
    bool operator==(const Index&) const = default;
  };

  explicit OccupancyMap(double cell) : edge_(cell) {}

  /// Enters the Ok beams of `scan` up to `reach` [m], taken by a scanner at `sensor_W`.
  void insert(const LaserScan& scan, const Pose2& sensor_W, double reach);
  /// Enters a beam from `from_W` that ended at `to_W`.
  void insert(const Vec2& from_W, const Vec2& to_W) {
    pass(from_W, to_W);
    hit(to_W);
  }
  /// Likewise, on a surface that faces as `facing_W`.
  void insert(const Vec2& from_W, const Vec2& to_W, const Facing& facing_W) {
    pass(from_W, to_W);
    face(hit(to_W), facing_W.side);
  }

  /// Adds what another map of the same cells counted.
  void add(const OccupancyMap& other);
  /// Takes over the walls of another map of the same cells in the square of half edge `reach` [m]
  /// about `p_W`, as if each had been hit once.
  void trace(const OccupancyMap& other, const Vec2& p_W, double reach);
  /// The number of the station from which the next scans are taken, below kMostStations.
  void set_station(std::size_t station) { station_ = static_cast<std::uint16_t>(station); }
  static constexpr std::size_t kMostStations = 0x10000;
  /// This map with each cell moved as the station from which it was seen last.
  OccupancyMap moved(std::span<const StationMove> stations) const;

  /// True if no wall lies on the line between two points.
  bool sees(const Vec2& from_W, const Vec2& to_W) const;

  /// Makes the cell of `p_W` a wall, or free, as a map read from a file says.
  void mark_wall(const Vec2& p_W, const Facing& facing_W = {}) { face(hit(p_W), facing_W.side); }
  void mark_free(const Vec2& p_W);

  /// Calls `see(point_W)` for each occupied cell of the square of half edge `reach` [m] about
  /// `p_W`, with the mean of its hits.
  template <typename See>
  void each_near(const Vec2& p_W, double reach, See&& see) const {
    each_tally_near(p_W, reach, [&](const Vec2& point_W, const Tally&) { see(point_W); });
  }
  /// Likewise `see(point_W, tally)`.
  template <typename See>
  void each_tally_near(const Vec2& p_W, double reach, See&& see) const {
    const Index low = cell_of(p_W - Vec2(reach, reach));
    const Index high = cell_of(p_W + Vec2(reach, reach));
    const Index first = tile_of(low);
    const Index last = tile_of(high);
    for (int tj = first.j; tj <= last.j; ++tj) {
      for (int ti = first.i; ti <= last.i; ++ti) {
        const Tile* tile = find({ti, tj});
        if (tile == nullptr) continue;
        const Index from{std::max(low.i, ti * kTileSide), std::max(low.j, tj * kTileSide)};
        const Index to{std::min(high.i, ti * kTileSide + kTileSide - 1),
                       std::min(high.j, tj * kTileSide + kTileSide - 1)};
        for (int j = from.j; j <= to.j; ++j) {
          for (int i = from.i; i <= to.i; ++i) {
            const Tally& tally = (*tile)[place({i, j})];
            if (tally.occupied()) see(mean_W({i, j}, tally), tally);
          }
        }
      }
    }
  }

  /// As each_near(), for the cells that may be of one surface with `facing_W`.
  template <typename See>
  void each_facing(const Vec2& p_W, const Facing& facing_W, double reach, See&& see) const {
    each_tally_near(p_W, reach, [&](const Vec2& point_W, const Tally& tally) {
      if (may_be_one(tally.facing(), facing_W)) see(point_W);
    });
  }

  /// Calls `see(cell, tally)` for each cell of each tile, in the order of tiles().
  template <typename See>
  void each_cell(See&& see) const {
    for (const Index& at : tiles()) {
      const Tile& tile = *find(at);
      for (int j = 0; j < kTileSide; ++j) {
        for (int i = 0; i < kTileSide; ++i) {
          const Index cell{at.i * kTileSide + i, at.j * kTileSide + j};
          see(cell, tile[place(cell)]);
        }
      }
    }
  }

  double cell_edge() const { return edge_; }
  /// All tiles, by row and column: the same for the same scans.
  std::vector<Index> tiles() const;
  /// [bytes] of the tiles.
  std::size_t bytes() const { return tiles_.size() * sizeof(Tile); }
  Index cell_of(const Vec2& p_W) const { return {index(p_W.x()), index(p_W.y())}; }
  Vec2 centre(const Index& c) const { return {(c.i + 0.5) * edge_, (c.j + 0.5) * edge_}; }
  Vec2 mean_W(const Index& at, const Tally& tally) const {
    return centre(at) + Vec2(static_cast<double>(tally.x), static_cast<double>(tally.y));
  }
  /// The cell's counts; none for a cell that no beam came near.
  Tally at(const Index& cell) const;

 private:
  using Tile = std::array<Tally, static_cast<std::size_t>(kTileSide* kTileSide)>;

  int index(double x) const {
    constexpr double kFarthest = 1e9;  // fits an int, with room for a window about it
    return static_cast<int>(std::clamp(std::floor(x / edge_), -kFarthest, kFarthest));
  }
  static int tile_index(int k) { return k >= 0 ? k / kTileSide : (k + 1) / kTileSide - 1; }
  static Index tile_of(const Index& c) { return {tile_index(c.i), tile_index(c.j)}; }
  static std::size_t place(const Index& c) {
    constexpr auto kMask = static_cast<unsigned>(kTileSide - 1);
    return (static_cast<unsigned>(c.j) & kMask) * kTileSide + (static_cast<unsigned>(c.i) & kMask);
  }
  static std::uint64_t key(const Index& tile) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(tile.j)) << 32U |
           static_cast<std::uint32_t>(tile.i);
  }
  const Tile* find(const Index& tile) const {
    const auto found = tiles_.find(key(tile));
    return found == tiles_.end() ? nullptr : found->second.get();
  }
  Tally& open(const Index& cell);
  void pass(const Vec2& from_W, const Vec2& to_W);
  Tally& hit(const Vec2& point_W);
  static void face(Tally& tally, const Vec2& normal_W);
  void add(const Index& cell, const Tally& tally);
  Tally moved(const Tally& tally, const Vec2& to_W, double turn) const;

  double edge_ = 0;  // [m]
  std::uint16_t station_ = 0;
  std::unordered_map<std::uint64_t, std::unique_ptr<Tile>> tiles_{};
  Index last_{};  // the tile opened last, and its place: beams stay in it for long
  Tile* last_tile_ = nullptr;
};

}  // namespace algo
