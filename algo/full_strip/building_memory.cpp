// algo/full_strip/building_memory.cpp: tiles, and the beams that cross them.
#include "algo/full_strip/building_memory.hpp"

#include <algorithm>
#include <new>

#include "algo/full_strip/mixed_beam.hpp"
#include "algo/wide.hpp"

namespace algo {
namespace {

constexpr std::uint8_t kDoubtHere = 8;    // raised by a mixed beam where it ends,
constexpr std::uint8_t kDoubtBeside = 4;  // and in the cells around: such ends lie far apart
constexpr std::uint8_t kMostDoubts = 40;
constexpr int kNearSteps = static_cast<int>(BuildingMemory::kNear / BuildingMemory::kCoarse);
constexpr int kMostSteps = static_cast<int>(BuildingMemory::kLook / BuildingMemory::kCoarse);
constexpr std::size_t kTileCount = std::size_t{BuildingMemory::kTiles} * BuildingMemory::kTiles;

/// The places [cells] along one axis of a beam's steps 0 to `steps`, each of length `way`.
using Places = std::array<int, std::size_t{kMostSteps} + 1>;
TAUTLINE_WIDE void find_places(double from, double way, int steps, Places& out) {
  for (int k = 0; k <= steps; ++k) out[static_cast<std::size_t>(k)] = whole_below(from + k * way);
}

}  // namespace

BuildingMemory::BuildingMemory()
    : tiles_(static_cast<Tile*>(std::calloc(kTileCount, sizeof(Tile)))) {
  if (tiles_ == nullptr) throw std::bad_alloc();
}

void BuildingMemory::reset() {
  for (std::size_t i = 0; i < kTileCount; ++i) {
    if (tiles_[i].used) tiles_[i].used = false;
  }
  empty_ = true;
  low_ = {};
  high_ = {};
  looks_ = 0;
}

/// The middles of the cells in which the robot has been.
std::vector<Vec2> BuildingMemory::driven_W() const {
  std::vector<Vec2> middles_W;
  for (std::size_t i = 0; i < kTileCount; ++i) {
    const Tile& tile = tiles_[i];
    for (std::size_t k = 0; tile.used && tile.driven != 0 && k < kCells; ++k) {
      if ((tile.driven >> k & 1U) == 0) continue;
      const auto x = static_cast<int>(k % kCoarseSide);
      const auto y = static_cast<int>(k / kCoarseSide);
      middles_W.push_back(middle_W({tile.column * kCoarseSide + x, tile.row * kCoarseSide + y}));
    }
  }
  return middles_W;
}

void BuildingMemory::draw(const MapMove& move) {
  static_assert(kCoarse == DrawnSpace::kCell);
  const std::vector<Vec2> driven = driven_W();
  reset();
  for (const Vec2& p_W : driven) {
    // It comes to lie between cells.
    for (const Vec2& off : {Vec2(-1, -1), Vec2(1, -1), Vec2(-1, 1), Vec2(1, 1)}) {
      drive(move.moved(p_W) + kCoarse / 4 * off);
    }
  }
  for (const Eigen::Vector2f& wall : move.walls_W) {
    const Vec2 p_W = wall.cast<double>();
    const int column = whole_below(p_W.x() / kFine);
    const int row = whole_below(p_W.y() / kFine);
    const int x = column & (kFineSide - 1);
    const int y = row & (kFineSide - 1);
    Tile& tile = get((column - x) / kFineSide, (row - y) / kFineSide);
    tile.occupied[static_cast<std::size_t>(y)] |= 1U << x;
  }
  for (const MapMove::Seen& seen : move.seen) {
    const Cell c{seen.column, seen.row};
    get(tile_of(c.column), tile_of(c.row)).seen[within(c)] = seen.beams;
  }
}

BuildingMemory::Tile& BuildingMemory::get(int column, int row) {
  Tile& tile = tiles_[place(column, row)];
  if (tile.used && tile.column == column && tile.row == row) return tile;
  tile.occupied.fill(0);
  tile.clearance.fill(kUnknown);
  tile.seen.fill(0);
  tile.doubts.fill(0);
  tile.near = 0;
  tile.driven = 0;
  tile.column = static_cast<std::int16_t>(column);
  tile.row = static_cast<std::int16_t>(row);
  tile.used = true;
  const Cell low{column * kCoarseSide, row * kCoarseSide};
  const Cell high{low.column + kCoarseSide, low.row + kCoarseSide};
  low_ = empty_ ? low : Cell{std::min(low_.column, low.column), std::min(low_.row, low.row)};
  high_ = empty_ ? high : Cell{std::max(high_.column, high.column), std::max(high_.row, high.row)};
  empty_ = false;
  return tile;
}

void BuildingMemory::look(const LaserScan& scan, const Pose2& sensor_W) {
  if (!(scan.angle_increment > 0)) return;
  // A stride so small that hardly a cell is skipped at kLook. Each call starts at another beam.
  const double apart = kCoarse / (kLook * scan.angle_increment);
  const auto stride = static_cast<std::size_t>(std::clamp(apart, 1.0, 64.0));
  const Vec2 from = sensor_W.position() / kCoarse;
  Places columns;
  Places rows;
  for (std::size_t i = ++looks_ % stride; i < scan.size(); i += stride) {
    if (scan.status[i] == Beam::Invalid) continue;
    const bool ends = scan.status[i] == Beam::Ok;
    const double length = std::min(kLook, scan.ranges[i] - (ends ? kCoarse : 0));
    const Vec2 way = direction(sensor_W.heading + scan.angle(i));
    const int steps = static_cast<int>(length / kCoarse);
    Tile* tile = nullptr;
    int column = 0;
    int row = 0;
    find_places(from.x(), way.x(), steps, columns);
    find_places(from.y(), way.y(), steps, rows);
    for (int k = 0; k <= steps; ++k) {
      const Cell c{columns[static_cast<std::size_t>(k)], rows[static_cast<std::size_t>(k)]};
      if (tile == nullptr || tile_of(c.column) != column || tile_of(c.row) != row) {
        column = tile_of(c.column);
        row = tile_of(c.row);
        tile = &get(column, row);
      }
      const std::size_t cell = within(c);
      if (tile->seen[cell] < kMostCrossings) ++tile->seen[cell];
      if (tile->doubts[cell] > 0) --tile->doubts[cell];
      if (k < kNearSteps) tile->near |= std::uint64_t{1} << cell;
    }
    if (ends && scan.ranges[i] < kNear) {
      const Cell c = cell_of(sensor_W.position() + scan.ranges[i] * way);
      get(tile_of(c.column), tile_of(c.row)).near |= std::uint64_t{1} << within(c);
    }
    if (beam_end(scan, i) == BeamEnd::Between && scan.ranges[i] < kLook) {
      doubt(cell_of(sensor_W.position() + scan.ranges[i] * way));
    }
  }
}

void BuildingMemory::doubt(Cell c) {
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      const Cell at{c.column + x, c.row + y};
      std::uint8_t& doubts = get(tile_of(at.column), tile_of(at.row)).doubts[within(at)];
      const int more = x == 0 && y == 0 ? kDoubtHere : kDoubtBeside;
      doubts = static_cast<std::uint8_t>(std::min<int>(kMostDoubts, doubts + more));
    }
  }
}

}  // namespace algo
