// algo/terrain/refused_edges.hpp: edges that the robot must not cross, as a scanner would see them.
#pragma once

#include <array>
#include <cstddef>

#include "algo/laser_scan.hpp"
#include "algo/layer.hpp"
#include "algo/types.hpp"

namespace algo {

/// A step too high or a trench too wide is below the laser's plane. Entered into the scan, its edge
/// is an obstacle to every reader of it, as the returns of the sonars are (SensorMerge), so that
/// any controller goes round it. The newest kMost are kept. Allocates nothing.
class RefusedEdges {
 public:
  static constexpr std::size_t kMost = 64;

  void reset() { count_ = 0; }
  bool empty() const { return count_ == 0; }
  /// The edge from `left_W` to `right_W`, found at `now` [s, run clock].
  void add(const Vec2& left_W, const Vec2& right_W, double now);
  /// Forgets edges older than `memory` [s].
  void forget(double now, double memory);
  /// [m] How far ahead of R the nearest edge lies within `half_width` [m] of its x axis; infinite
  /// if none does.
  double ahead(const Pose2& pose_W, double half_width) const;
  /// Enters the edges into `scan`, taken by a robot at `pose_W`.
  void enter(const Pose2& pose_W, LaserScan& scan) const;
  /// Appends them to a polyline layer.
  void show(Layer& layer) const;

 private:
  struct Edge {
    Vec2 a_W{0, 0};
    Vec2 b_W{0, 0};
    double found = 0;  // [s] run clock
  };
  std::array<Edge, kMost> edges_{};  // oldest first
  std::size_t count_ = 0;
};

}  // namespace algo
