// algo/full_strip/strip_senses.hpp: the full strip's picture of the world: the map of the scans,
// what is remembered beyond it, and the tracks of moving obstacles.
#pragma once

#include "algo/controller.hpp"
#include "algo/full_strip/building_memory.hpp"
#include "algo/full_strip/local_map.hpp"
#include "algo/full_strip/motion.hpp"
#include "algo/full_strip/scan_points.hpp"
#include "algo/full_strip/tracker.hpp"

namespace algo {

class StripSenses {
 public:
  StripSenses();
  void reset(const Pose2& start_W);
  /// The map moved, and the robot, now at `here_W`, with it. Allocates.
  void move(const MapMove& move, const Pose2& here_W, const HullCheck& hull);
  /// Enters the scan of this tick, if it is new, each beam from the pose at which it was fired.
  /// `track`: whether to look for moving obstacles.
  void update(const ControlInput& in, const HullCheck& hull, bool track);

  /// Frees what is in the map on little evidence.
  void forget_doubtful() { map_.forget_doubtful(); }
  /// Frees what the robot has not seen for long, once for a goal. If walls faded while it searches,
  /// it would look at the ends of lanes in turn for ever.
  void forget_old() { map_.forget_old(); }

  const LocalMap& map() const { return map_; }
  const BuildingMemory& memory() const { return memory_; }
  const Tracker& tracker() const { return tracker_; }
  /// The ends of the newest scan's beams that lie close to the hull.
  const Recycled<Vec2>& close_W() const { return close_W_; }

 private:
  void find_close(const LaserScan& scan, const ControlInput& in);
  void forget_traces(const ControlInput& in, const HullCheck& hull);

  ScanPoints points_{};
  LocalMap map_{LocalMap::Distances::Kept, LocalMap::Ageing::ByWay};
  BuildingMemory memory_{};
  Tracker tracker_{};
  Recycled<Vec2> close_W_{};
  bool placed_ = false;  // the start pose is entered into the map
};

}  // namespace algo
