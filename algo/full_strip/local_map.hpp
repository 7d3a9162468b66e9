// algo/full_strip/local_map.hpp: a rolling occupancy grid of the scans around the robot, and the
// distance to the nearest occupied cell.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "algo/full_strip/building_memory.hpp"
#include "algo/full_strip/distance_field.hpp"
#include "algo/full_strip/seen_space.hpp"
#include "algo/full_strip/tracker.hpp"
#include "algo/laser_scan.hpp"
#include "algo/layer.hpp"
#include "algo/types.hpp"

namespace algo {

/// A square window of the odometry frame W that follows the robot in whole cells.
///
/// A cell is occupied after two hits. It is free again after the scanner has looked through it
/// several times. Where the scanner does not look, a cell ages, and then counts as never seen. Ages
/// count scans, and old cells fade; or they count the robot's way, and old cells stay until
/// forget_old(). Allocates in the constructor only.
class LocalMap {
 public:
  static constexpr double kCell = DistanceField::kCell;    // [m]
  static constexpr int kSize = DistanceField::kSize;       // cells along an edge: 25.6 m
  static constexpr double kReach = DistanceField::kReach;  // [m] distances are known up to here
  static constexpr std::uint8_t kOccupied = 3;             // hits that make a cell occupied: two
  static constexpr std::uint8_t kMost = 8;                 // hits that count
  static constexpr std::size_t kMostBeams = 4096;          // of a scan; reserved from the start

  /// Whether to keep the distances to the nearest occupied cell, which take half of a map's memory
  /// and most of its work. Without them do not call distance(), gradient(), sees() or
  /// cell_distance().
  enum class Distances : std::uint8_t { Kept, None };
  enum class Ageing : std::uint8_t { ByScans, ByWay };
  explicit LocalMap(Distances distances = Distances::Kept, Ageing ageing = Ageing::ByScans);
  bool keeps_distances() const { return field_.has_value(); }

  /// Forgets everything and centres the window on `centre_W`.
  void reset(const Vec2& centre_W);

  /// Sets the number of scans, or of kWayUnit of way, without a hit after which a cell is old.
  void remember_for(std::uint16_t age) { age_after_ = age; }
  static constexpr double kWayUnit = 0.1;  // [m]

  /// Moves the window if the robot has left its middle; true if it moved. What leaves the window is
  /// kept in `memory`, and what enters it is read from there.
  bool follow(const Vec2& position_W, BuildingMemory* memory = nullptr);
  /// Forgets everything but the seen space, and takes the walls of a map of the window about
  /// `centre_W`.
  void draw(const Vec2& centre_W, std::span<const Eigen::Vector2f> walls_W);
  /// Middles of windows whose inner tiles cover all of `memory`.
  static std::vector<Vec2> windows_over(const BuildingMemory& memory);
  /// Writes the clearances of `tiles` of the window's tiles into the coarse layer of `memory`, in
  /// turn. Left out are the window's outermost tiles, whose surroundings are not known. A robot
  /// needs `least` [m]; with `exact`, clearances close to it are measured to the hits themselves,
  /// as the planner does: it must not find a way from afar that it finds shut when it is near. A
  /// tile stays as it is where nothing has changed since its last turn: each call has the same
  /// arguments.
  static constexpr int kInner = DistanceField::kTiles - 2;  // surveyed tiles along the edge
  void survey(int tiles, double least, bool exact, BuildingMemory& memory);

  /// Enters the hits of `scan` as points of W, except those on moving obstacles, and clears the
  /// cells that it looked through. `sensor_W` is the scanner's pose at the middle of its sweep,
  /// `points_W` B points (only those of Ok beams count).
  void insert(const LaserScan& scan,
              const Pose2& sensor_W,
              const std::vector<Vec2>& points_W,
              const Tracker& tracker);
  /// Frees each occupied or suspected cell for which `free(point_W)` holds, in the square of half
  /// edge `reach` [m] about `p_W`: the robot's own place, or an obstacle that has begun to move.
  template <typename Free>
  void erase_near(const Vec2& p_W, double reach, Free&& free) {
    each_cell(p_W, reach, [&](std::size_t cell) {
      if (hits_[cell] > 0 && free(mean_W(cell))) clear(cell);
    });
  }

  /// Frees the cells with few hits: ghosts at the edges of things have few, walls have many.
  void forget_doubtful();
  /// Frees the old cells, which then count as never seen.
  void forget_old() { age(kMost); }

  /// [m] Distance from `p_W` to the nearest occupied cell's centre, at most kReach; kReach outside.
  double distance(const Vec2& p_W) const;
  /// Gradient of distance(): away from the nearest obstacle; zero if none is within reach.
  Vec2 gradient(const Vec2& p_W) const;

  /// Calls `see(point_W)` for each occupied cell of the square of half edge `reach` [m] about
  /// `p_W`. The point is the mean of the cell's hits, which is closer to the surface than its
  /// centre.
  template <typename See>
  void each_near(const Vec2& p_W, double reach, See&& see) const {
    each_cell(p_W, reach, [&](std::size_t cell) {
      if (hits_[cell] >= kOccupied) see(mean_W(cell));
    });
  }

  /// True if the straight line between two points keeps `room` [m] from all occupied cells.
  bool sees(const Vec2& from_W, const Vec2& to_W, double room) const;
  const Vec2& corner_W() const { return corner_W_; }
  /// [mm] Distance of the cell (column, row), which must be inside.
  std::int16_t cell_distance(int column, int row) const { return field_->at(column, row); }
  /// The space that the scanner has seen: elsewhere, a cell without hits is unknown, not free.
  const SeenSpace& seen() const { return space_; }
  SeenSpace& seen() { return space_; }

  /// Draws the displayed part: `side` x `side` cells about the robot.
  void draw(const Vec2& about_W, std::uint32_t side, Layer& out) const;

 private:
  /// The mean of a cell's hits, from its centre [m].
  using Offset = std::array<float, 2>;
  /// The data of a cell with hits while it moves to another place in memory.
  struct Moved {
    std::uint32_t cell = 0;
    std::uint16_t seen = 0;
    std::uint8_t hits = 0;
    Offset mean{};
  };
  /// Calls `visit(cell)` for each cell of the square of half edge `reach` [m] about `p_W`.
  template <typename Visit>
  void each_cell(const Vec2& p_W, double reach, Visit&& visit) const {
    const auto place = [](double metres) { return whole_below(metres / kCell); };
    const Vec2 low = p_W - Vec2(reach, reach);
    const Vec2 high = p_W + Vec2(reach, reach);
    const int x0 = std::max(0, place(low.x() - corner_W_.x()));
    const int x1 = std::min(kSize - 1, place(high.x() - corner_W_.x()));
    const int y0 = std::max(0, place(low.y() - corner_W_.y()));
    const int y1 = std::min(kSize - 1, place(high.y() - corner_W_.y()));
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) visit(index(x, y));
    }
  }
  double room_through(int column, int row, double least, bool exact) const;
  Vec2 centre_W(std::size_t cell) const {
    const auto column = static_cast<double>(cell % kSize);
    const std::size_t row = cell / kSize;
    return corner_W_ + Vec2((column + 0.5) * kCell, (static_cast<double>(row) + 0.5) * kCell);
  }
  Vec2 mean_W(std::size_t cell) const {
    const Offset& o = means_[cell];
    return centre_W(cell) + Vec2(static_cast<double>(o[0]), static_cast<double>(o[1]));
  }
  static std::size_t index(int column, int row) { return DistanceField::index(column, row); }
  /// The row-major index of a tile of the window.
  static std::size_t tile_index(int column, int row) {
    return static_cast<std::size_t>(row) * DistanceField::kTiles + static_cast<std::size_t>(column);
  }
  /// Of the tile of a cell.
  static std::size_t tile_at(int column, int row) {
    return tile_index(column / DistanceField::kTile, row / DistanceField::kTile);
  }
  void forget_cells(const Vec2& centre_W);
  bool is_surveyed(int tile_x, int tile_y) const;
  void hit(const Vec2& point_W);
  void look_through(const LaserScan& scan, const Pose2& sensor_W);
  void doubt_suspects();
  void age(int by);
  bool weaken(std::size_t cell, int by);
  void clear(std::size_t cell);
  void drop_active(std::size_t i);
  void shift(int tile_columns, int tile_rows, BuildingMemory* memory);
  void keep_leaving(int tile_columns, int tile_rows, BuildingMemory& memory) const;
  void restore_entering(int tile_columns, int tile_rows, const BuildingMemory& memory);
  void occupy(std::size_t cell);
  void restore(int column, int row, const BuildingMemory::Tile& tile);
  int tile_column() const;
  int tile_row() const;
  std::uint16_t now() const;

  Vec2 corner_W_{0, 0};
  struct Release {
    void operator()(void* memory) const { std::free(memory); }
  };

  // Only cells with hits are written: most of a window takes up no memory.
  std::unique_ptr<std::uint8_t[], Release> hits_;
  std::unique_ptr<std::uint16_t[]> seen_;  // now() at the last hit
  std::unique_ptr<Offset[]> means_;        // of the hits
  std::vector<Moved> moved_;
  std::vector<std::uint32_t> active_;    // cells with hits
  std::vector<std::uint32_t> suspects_;  // cells that the last scan hit for the first time
  std::optional<DistanceField> field_{};
  SeenSpace space_{};
  std::uint16_t age_after_ = 20 * 30;
  Ageing ageing_ = Ageing::ByScans;
  std::uint32_t scans_ = 0;
  double way_ = 0;                // [m] driven
  std::optional<Vec2> last_W_{};  // place of the robot
  int next_survey_ = 0;           // of the window's tiles
  std::uint32_t surveys_ = 0;     // calls of survey()
  /// A number for each tile of the window.
  using TileStamps =
      std::array<std::uint32_t, std::size_t{DistanceField::kTiles} * DistanceField::kTiles>;
  TileStamps changed_{};                  // surveys_ when the tile last changed
  TileStamps surveyed_{};                 // surveys_ when the tile was last surveyed; 0: never
  std::array<std::uint32_t, 2> looks_{};  // by scanners that look ahead, and back
};

}  // namespace algo
