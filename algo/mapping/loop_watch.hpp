// algo/mapping/loop_watch.hpp: notices that a robot on new ground is back on ground that it knows.
#pragma once

#include <optional>

#include "algo/mapping/occupancy_map.hpp"
#include "algo/mapping/scan_matcher.hpp"
#include "algo/types.hpp"

namespace algo {

/// Believes a place only after some way on which all scans fit the old map, at one and the same
/// move of it: one scan alone may fit a place that looks alike.
class LoopWatch {
 public:
  /// Forgets what fitted.
  void reset();

  /// Takes a scan of a robot that is at `pose_W` by its way, `way` [m] after the scan before.
  /// `matcher` holds the scan. `search`: an old station is so near that the scan should fit; then
  /// it is searched for too, if it does not fit where the way says. Returns the pose by the old
  /// map, once it is believed.
  std::optional<Pose2> see(const ScanMatcher& matcher,
                           const OccupancyMap& old,
                           const Pose2& pose_W,
                           double way,
                           bool search,
                           const MatchPrior& prior);

 private:
  std::optional<Pose2> move_;  // of the old map onto the way, by the first scan that fitted
  double fitted_ = 0;          // [m] of way since
  double missed_ = 0;          // [m] since the last scan that fitted
  double unsearched_ = 0;      // [m] since the last search
};

}  // namespace algo
