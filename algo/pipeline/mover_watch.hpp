// algo/pipeline/mover_watch.hpp: the obstacles that a scanner has seen moving, for a guard.
#pragma once

#include <limits>
#include <vector>

#include "algo/full_strip/tracker.hpp"
#include "algo/types.hpp"

namespace algo {

/// Follows the moving obstacles in the scans of one scanner. A body that only might move counts as
/// standing: it is in the map. Nothing is freed there for a track's sake: the end of a wall can
/// look as if it moved, and beams that pass clear the places that a person has left.
class MoverWatch {
 public:
  static constexpr double kGap = 0.3;  // [s] without a scan, after which it begins anew

  void reset();
  /// Takes a scan, as in Tracker::update().
  void take(const LaserScan& scan, const Pose2& sensor_W, const std::vector<Vec2>& points_W);
  /// Calls `see(track)` for all that moves, with its position at `now` [s, run clock].
  template <typename See>
  void each(double now, See&& see) {
    if (now - stamp_ > kLongest) return;
    tracker_.predict(now);
    for (const Track& track : tracker_.moving()) {
      if (track.moves) see(track);
    }
  }

 private:
  static constexpr double kLongest = 1.0;  // [s] a prediction holds without any scan
  Tracker tracker_{};
  double stamp_ = -std::numeric_limits<double>::infinity();  // [s] of the newest scan
};

}  // namespace algo
