// algo/full_strip/seen_space.hpp: the space around the robot that the scanner has seen. A robot may
// back only into seen space.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "algo/laser_scan.hpp"
#include "algo/map_move.hpp"
#include "algo/types.hpp"

namespace algo {

/// A square window of the odometry frame W that follows the robot. A cell is seen if a beam passed
/// through it or ended in it or just before it. The map tells whether a seen cell is occupied.
/// Allocates in the constructor only.
class SeenSpace {
 public:
  static constexpr double kCell = 0.05;  // [m]
  static constexpr int kSize = 256;      // cells along an edge, a power of two: 12.8 m

  SeenSpace() : seen_(static_cast<std::size_t>(kSize) * kSize) { reset({0, 0}); }

  /// Forgets everything and centres the window on `centre_W`.
  void reset(const Vec2& centre_W);
  /// Moves the window with the robot.
  void follow(const Vec2& position_W);

  /// Moves what was seen with the robot.
  void move(const MapMove& move);

  /// Enters the beams of `scan`, taken at `sensor_W`, up to kLook.
  void look(const LaserScan& scan, const Pose2& sensor_W);
  /// Marks the disc about `centre_W` as seen: the robot stands there, or has room to turn there.
  void mark(const Vec2& centre_W, double radius) { set_disc(centre_W, radius, 1); }
  /// Marks the disc about `centre_W` as never seen.
  void forget(const Vec2& centre_W, double radius) { set_disc(centre_W, radius, 0); }

  bool seen(const Vec2& p_W) const {
    const int column = cell_of(p_W.x());
    const int row = cell_of(p_W.y());
    return holds(column, row) && seen_[index(column, row)] != 0;
  }

 private:
  static int cell_of(double metres) { return whole_below(metres / kCell); }
  /// Cells of the plane map to those of the window periodically, as on a torus.
  static std::size_t index(int column, int row) {
    constexpr auto kMask = static_cast<unsigned>(kSize - 1);
    return (static_cast<unsigned>(row) & kMask) * static_cast<std::size_t>(kSize) +
           (static_cast<unsigned>(column) & kMask);
  }
  bool holds(int column, int row) const {
    return column >= left_ && column < left_ + kSize && row >= bottom_ && row < bottom_ + kSize;
  }
  void set_disc(const Vec2& centre_W, double radius, std::uint8_t seen);

  std::vector<std::uint8_t> seen_;  // 0: never
  int left_ = 0, bottom_ = 0;       // corner of the window, in cells of W
  std::size_t looks_ = 0;
};

}  // namespace algo
