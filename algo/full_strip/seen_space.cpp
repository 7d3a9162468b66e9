// algo/full_strip/seen_space.cpp: draws beams into a rolling window.
#include "algo/full_strip/seen_space.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace algo {
namespace {

constexpr double kLook = 2.0;    // [m] along a beam; nothing beyond it is needed soon
constexpr double kBehind = 0.1;  // [m] behind a surface, reachable only through it

/// Places along a beam, in cells with 32 bits behind the point: a sum of whole numbers is cheaper
/// than a product and its floor.
constexpr int kFraction = 32;
std::int64_t fixed(double cells) {
  return std::llround(std::ldexp(cells, kFraction));
}

}  // namespace

void SeenSpace::reset(const Vec2& centre_W) {
  std::ranges::fill(seen_, std::uint8_t{0});
  left_ = cell_of(centre_W.x()) - kSize / 2;
  bottom_ = cell_of(centre_W.y()) - kSize / 2;
  looks_ = 0;
}

void SeenSpace::follow(const Vec2& position_W) {
  const int left = cell_of(position_W.x()) - kSize / 2;
  const int bottom = cell_of(position_W.y()) - kSize / 2;
  if (std::abs(left - left_) >= kSize || std::abs(bottom - bottom_) >= kSize) {
    reset(position_W);
    return;
  }
  // New cells on one side reuse the memory of those that leave on the other.
  for (; left_ != left; left_ += left > left_ ? 1 : -1) {
    const int column = left > left_ ? left_ : left_ - 1;
    for (int row = 0; row < kSize; ++row) seen_[index(column, row)] = 0;
  }
  for (; bottom_ != bottom; bottom_ += bottom > bottom_ ? 1 : -1) {
    const int row = bottom > bottom_ ? bottom_ : bottom_ - 1;
    std::fill_n(&seen_[index(0, row)], kSize, std::uint8_t{0});
  }
}

void SeenSpace::move(const MapMove& move) {
  const SeenSpace before = *this;
  follow(move.to_W.position());
  for (int row = bottom_; row < bottom_ + kSize; ++row) {
    for (int column = left_; column < left_ + kSize; ++column) {
      const Vec2 middle_W = kCell * Vec2(column + 0.5, row + 0.5);
      seen_[index(column, row)] = before.seen(move.moved_back(middle_W)) ? 1 : 0;
    }
  }
}

void SeenSpace::look(const LaserScan& scan, const Pose2& sensor_W) {
  const Vec2 middle_W = Vec2(left_ + kSize / 2, bottom_ + kSize / 2) * kCell;
  const bool near = (sensor_W.position() - middle_W).norm() < kSize * kCell / 2 - kLook - 2 * kCell;
  if (!near || !(scan.angle_increment > 0)) return;
  // A stride so small that no cell is skipped at kLook. Each call starts at another beam.
  const double apart = kCell / (kLook * scan.angle_increment);
  const auto stride = static_cast<std::size_t>(std::clamp(apart, 1.0, 64.0));
  std::uint8_t* const seen = seen_.data();  // a local copy: byte stores may alias members
  const std::int64_t from_x = fixed(sensor_W.x / kCell);
  const std::int64_t from_y = fixed(sensor_W.y / kCell);
  for (std::size_t i = ++looks_ % stride; i < scan.size(); i += stride) {
    if (scan.status[i] == Beam::Invalid) continue;
    const bool hit = scan.status[i] == Beam::Ok;
    const double length = std::min(kLook, hit ? scan.ranges[i] + kBehind : scan.ranges[i]);
    const Vec2 way = direction(sensor_W.heading + scan.angle(i));
    const int steps = static_cast<int>(length / kCell);
    const std::int64_t step_x = fixed(way.x());
    const std::int64_t step_y = fixed(way.y());
    std::int64_t x = from_x;
    std::int64_t y = from_y;
    for (int k = 0; k <= steps; ++k, x += step_x, y += step_y) {
      seen[index(static_cast<int>(x >> kFraction), static_cast<int>(y >> kFraction))] = 1;
    }
  }
}

void SeenSpace::set_disc(const Vec2& centre_W, double radius, std::uint8_t seen) {
  const int reach = static_cast<int>(radius / kCell) + 1;
  const int column = cell_of(centre_W.x());
  const int row = cell_of(centre_W.y());
  for (int y = row - reach; y <= row + reach; ++y) {
    for (int x = column - reach; x <= column + reach; ++x) {
      const Vec2 middle_W = Vec2(x + 0.5, y + 0.5) * kCell;
      const bool inside = (middle_W - centre_W).squaredNorm() <= radius * radius;
      if (inside && holds(x, y)) seen_[index(x, y)] = seen;
    }
  }
}

}  // namespace algo
