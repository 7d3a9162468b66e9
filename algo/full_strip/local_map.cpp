// algo/full_strip/local_map.cpp: enters hits, clears cells that beams passed, and gives distances.
#include "algo/full_strip/local_map.hpp"

#include <algorithm>
#include <cmath>
#include <new>
#include <numbers>
#include <span>

#include "algo/full_strip/mixed_beam.hpp"

namespace algo {
namespace {

constexpr std::uint8_t kPerHit = 2;      // added by a hit, up to kMost
constexpr std::uint8_t kSure = 6;        // hits from which a cell is not doubted
constexpr int kPerLook = 2;              // removed when a beam passes
constexpr double kBehindCell = 0.15;     // [m] a beam must go on this far behind a cell to clear it
constexpr double kClearRange = 8.0;      // [m] cells farther than this are left unchanged
constexpr std::uint32_t kAgeEvery = 64;  // scans between two checks of the cells' ages
constexpr double kFaded = 0.15;          // [m] around a faded cell: its obstacle may still be there

constexpr std::size_t kCells = std::size_t{LocalMap::kSize} * LocalMap::kSize;
constexpr double kMiddle = 4.0;  // [m] the robot may be this far from the window's middle
constexpr double kTileEdge = BuildingMemory::kTileEdge;  // [m]

}  // namespace

LocalMap::LocalMap(Distances distances, Ageing ageing)
    : hits_(static_cast<std::uint8_t*>(std::calloc(kCells, 1))),
      seen_(std::make_unique_for_overwrite<std::uint16_t[]>(kCells)),
      means_(std::make_unique_for_overwrite<Offset[]>(kCells)),
      ageing_(ageing) {
  if (hits_ == nullptr) throw std::bad_alloc();
  active_.reserve(kCells);
  moved_.reserve(kCells);
  suspects_.reserve(kMostBeams);
  if (distances == Distances::Kept) field_.emplace();
  reset({0, 0});
}

void LocalMap::reset(const Vec2& centre_W) {
  scans_ = 0;
  looks_ = {};
  way_ = 0;
  next_survey_ = 0;
  space_.reset(centre_W);
  forget_cells(centre_W);
}

/// Empties the window, and centres it on `centre_W`.
void LocalMap::forget_cells(const Vec2& centre_W) {
  for (const std::uint32_t cell : active_) hits_[cell] = 0;
  if (field_) field_->reset();
  active_.clear();
  suspects_.clear();
  last_W_.reset();
  surveyed_.fill(0);
  const double half = kSize * kCell / 2;
  corner_W_ = {std::round((centre_W.x() - half) / kTileEdge) * kTileEdge,
               std::round((centre_W.y() - half) / kTileEdge) * kTileEdge};
}

std::uint16_t LocalMap::now() const {
  return static_cast<std::uint16_t>(
      ageing_ == Ageing::ByScans ? scans_ : static_cast<std::uint32_t>(way_ / kWayUnit));
}

bool LocalMap::follow(const Vec2& position_W, BuildingMemory* memory) {
  space_.follow(position_W);
  if (last_W_) way_ += (position_W - *last_W_).norm();
  last_W_ = position_W;
  const double half = kSize * kCell / 2;
  const Vec2 off = position_W - corner_W_ - Vec2(half, half);
  if (std::abs(off.x()) < kMiddle && std::abs(off.y()) < kMiddle) return false;
  const auto tiles = [](double metres) {
    return static_cast<int>(std::lround(metres / (LocalMap::kCell * DistanceField::kTile)));
  };
  shift(tiles(off.x()), tiles(off.y()), memory);
  return true;
}

/// Copies the cells that stay inside. Forgets those that leave; new ones are free, unless `memory`
/// knows better.
void LocalMap::shift(int tile_columns, int tile_rows, BuildingMemory* memory) {
  if (memory != nullptr) keep_leaving(tile_columns, tile_rows, *memory);
  surveyed_.fill(0);
  const int columns = tile_columns * DistanceField::kTile;
  const int rows = tile_rows * DistanceField::kTile;
  corner_W_ += Vec2(columns * kCell, rows * kCell);
  if (field_) field_->shift(tile_columns, tile_rows);
  moved_.clear();
  for (const std::uint32_t old : active_) {
    const int column = static_cast<int>(old) % kSize - columns;
    const int row = static_cast<int>(old) / kSize - rows;
    if (column < 0 || row < 0 || column >= kSize || row >= kSize) continue;
    moved_.push_back(
        {static_cast<std::uint32_t>(index(column, row)), seen_[old], hits_[old], means_[old]});
  }
  for (const std::uint32_t old : active_) hits_[old] = 0;
  active_.clear();
  for (const Moved& moved : moved_) {
    active_.push_back(moved.cell);
    seen_[moved.cell] = moved.seen;
    means_[moved.cell] = moved.mean;
    hits_[moved.cell] = moved.hits;
    const int column = static_cast<int>(moved.cell) % kSize;
    const int row = static_cast<int>(moved.cell) / kSize;
    const bool lowers = field_ && moved.hits >= kOccupied &&
                        DistanceField::beside_new(column, row, tile_columns, tile_rows);
    if (lowers) field_->occupy(column, row);
  }
  if (memory != nullptr) restore_entering(tile_columns, tile_rows, *memory);
}

void LocalMap::insert(const LaserScan& scan,
                      const Pose2& sensor_W,
                      const std::vector<Vec2>& points_W,
                      const Tracker& tracker) {
  ++scans_;
  suspects_.clear();
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (scan.status[i] == Beam::Ok && !tracker.on_moving(i) &&
        beam_end(scan, i) == BeamEnd::Surface) {
      hit(points_W[i]);
    }
  }
  look_through(scan, sensor_W);
  space_.look(scan, sensor_W);
  doubt_suspects();
  if (ageing_ == Ageing::ByScans && scans_ % kAgeEvery == 0) age(1);
  if (!field_) return;
  for (const std::uint16_t tile : field_->rebuild(std::span(hits_.get(), kCells), kOccupied)) {
    changed_[tile] = surveys_;
  }
}

void LocalMap::hit(const Vec2& point_W) {
  const Vec2 p = (point_W - corner_W_) / kCell;
  if (!(p.x() >= 0 && p.y() >= 0 && p.x() < kSize && p.y() < kSize)) return;
  const int column = static_cast<int>(p.x());
  const int row = static_cast<int>(p.y());
  const std::size_t cell = index(column, row);
  const std::uint8_t before = hits_[cell];
  if (before == 0) active_.push_back(static_cast<std::uint32_t>(cell));
  hits_[cell] = std::min<std::uint8_t>(kMost, before + kPerHit);
  seen_[cell] = now();
  // A mean that forgets, so that it follows drift.
  const Vec2 off = point_W - centre_W(cell);
  Offset& mean = means_[cell];
  if (before == 0) mean = {};
  const float share = before == 0 ? 1.0F : 1.0F / static_cast<float>(before + kPerHit);
  mean[0] += share * (static_cast<float>(off.x()) - mean[0]);
  mean[1] += share * (static_cast<float>(off.y()) - mean[1]);
  if (hits_[cell] < kOccupied) {
    suspects_.push_back(static_cast<std::uint32_t>(cell));
  } else {
    changed_[tile_at(column, row)] = surveys_;
  }
  const bool becomes_occupied = before < kOccupied && hits_[cell] >= kOccupied;
  if (becomes_occupied && field_) field_->occupy(column, row);
}

/// Removes hits from a cell. False if none are left.
bool LocalMap::weaken(std::size_t cell, int by) {
  const std::uint8_t before = hits_[cell];
  hits_[cell] = static_cast<std::uint8_t>(std::max(0, before - by));
  if (field_ && before >= kOccupied && hits_[cell] < kOccupied) {
    const int column = static_cast<int>(cell) % kSize;
    const int row = static_cast<int>(cell) / kSize;
    field_->free(column, row);
    changed_[tile_at(column, row)] = surveys_;
  }
  return hits_[cell] > 0;
}

/// Checks every second cell per scan, and weakens those that three neighbouring beams look beyond.
/// Scanners that look ahead and back alternate their scans, so each has its own counter; with a
/// shared one each would only ever check one half of the cells.
void LocalMap::look_through(const LaserScan& scan, const Pose2& sensor_W) {
  if (scan.size() < 3 || !(scan.angle_increment > 0)) return;
  const Vec2 ahead = direction(sensor_W.heading);
  const double per_radian = 1 / scan.angle_increment;
  const double doubt = kRoughBearing * per_radian;  // [beams] nearer to a limit it asks exactly
  const auto last = static_cast<double>(scan.size() - 2);
  const bool back = std::abs(scan.mount_R.heading) > std::numbers::pi / 2;
  for (std::size_t i = ++looks_[back ? 1 : 0] % 2; i < active_.size(); i += 2) {
    const std::size_t cell = active_[i];
    const Vec2 d = centre_W(cell) - sensor_W.position();
    const double far = d.squaredNorm();
    if (far > kClearRange * kClearRange) continue;
    const double left = cross(ahead, d);
    const double along = ahead.dot(d);
    double beam = (rough_bearing(left, along) - scan.angle_min) * per_radian + 0.5;
    const double part = beam - std::floor(beam);
    if (part < doubt || part + doubt >= 1) {
      beam = (std::atan2(left, along) - scan.angle_min) * per_radian + 0.5;
    }
    if (!(beam >= 1 && beam < last)) continue;
    const auto b = static_cast<std::size_t>(beam);
    double nearest = scan.range_max;
    bool measured = true;
    for (std::size_t k = b - 1; k <= b + 1; ++k) {
      measured = measured && scan.status[k] != Beam::Invalid;
      if (scan.status[k] == Beam::Ok) nearest = std::min(nearest, scan.ranges[k]);
    }
    const double reach = nearest - kBehindCell;
    if (!measured || reach <= 0 || reach * reach < far) continue;
    if (!weaken(cell, kPerLook)) drop_active(i);
  }
}

/// A place where an obstacle may stand does not count as seen.
void LocalMap::doubt_suspects() {
  for (const std::uint32_t cell : suspects_) {
    if (hits_[cell] < kOccupied) space_.forget(centre_W(cell), kCell / 2);
  }
}

void LocalMap::clear(std::size_t cell) {
  weaken(cell, kMost);
  const auto listed = std::ranges::find(active_, static_cast<std::uint32_t>(cell));
  if (listed != active_.end()) drop_active(static_cast<std::size_t>(listed - active_.begin()));
}

/// Removes the `i`th from the list; the last takes its place.
void LocalMap::drop_active(std::size_t i) {
  active_[i] = active_.back();
  active_.pop_back();
}

void LocalMap::forget_doubtful() {
  for (std::size_t i = 0; i < active_.size();) {
    const std::size_t cell = active_[i];
    if (hits_[cell] >= kSure) {
      ++i;
      continue;
    }
    weaken(cell, kMost);
    drop_active(i);
  }
}

/// Removes hits from the old cells.
void LocalMap::age(int by) {
  for (std::size_t i = 0; i < active_.size();) {
    const std::size_t cell = active_[i];
    const auto since = static_cast<std::uint16_t>(now() - seen_[cell]);
    if (since < age_after_) {
      ++i;
      continue;
    }
    weaken(cell, by);
    if (hits_[cell] >= kOccupied) {
      ++i;
      continue;
    }
    // It is no longer occupied, so it must not count as seen and free either.
    hits_[cell] = 0;
    space_.forget(mean_W(cell), kFaded);
    drop_active(i);
  }
}

double LocalMap::distance(const Vec2& p_W) const {
  // Interpolates between the four cell centres around.
  const double x = (p_W.x() - corner_W_.x()) / kCell - 0.5;
  const double y = (p_W.y() - corner_W_.y()) / kCell - 0.5;
  if (!(x >= 0 && y >= 0 && x < kSize - 1 && y < kSize - 1)) return kReach;
  const int column = static_cast<int>(x);
  const int row = static_cast<int>(y);
  const double u = x - column;
  const double v = y - row;
  const std::int16_t* low = field_->from(column, row);
  const std::int16_t* high = low + kSize;
  const double below = low[0] + u * (low[1] - low[0]);
  const double above = high[0] + u * (high[1] - high[0]);
  return (below + v * (above - below)) * 0.001;
}

bool LocalMap::sees(const Vec2& from_W, const Vec2& to_W, double room) const {
  const Vec2 way = to_W - from_W;
  const double length = way.norm();
  if (length < 1e-6) return true;
  for (double s = 0; s < length;) {
    const double d = distance(from_W + way * (s / length));
    if (d < room && s > room) return false;
    s += std::max(kCell, d - room);
  }
  return true;
}

Vec2 LocalMap::gradient(const Vec2& p_W) const {
  const double h = kCell;
  const Vec2 slope{distance(p_W + Vec2(h, 0)) - distance(p_W - Vec2(h, 0)),
                   distance(p_W + Vec2(0, h)) - distance(p_W - Vec2(0, h))};
  const double length = slope.norm();
  if (length < 1e-6) return {0, 0};
  return slope / length;
}

void LocalMap::draw(const Vec2& about_W, std::uint32_t side, Layer& out) const {
  const int half = static_cast<int>(side) / 2;
  const Vec2 p = (about_W - corner_W_) / kCell;
  const int left = std::clamp(static_cast<int>(p.x()) - half, 0, kSize - 2 * half);
  const int bottom = std::clamp(static_cast<int>(p.y()) - half, 0, kSize - 2 * half);
  const std::size_t columns = std::size_t{2} * static_cast<std::size_t>(half);
  put(out, Vec2(corner_W_ + Vec2(left * kCell, bottom * kCell)), kCell, 2 * half);
  out.cells.resize(columns * columns);
  for (int y = 0; y < 2 * half; ++y) {
    const std::uint8_t* from = &hits_[index(left, bottom + y)];
    std::uint8_t* to = &out.cells[static_cast<std::size_t>(y) * columns];
    for (int x = 0; x < 2 * half; ++x) to[x] = from[x] >= kOccupied ? 254 : 0;
  }
}

}  // namespace algo
