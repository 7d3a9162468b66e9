// algo/mapping/scan_odometry.hpp: odometry whose drift is taken out by matching scans to the map of
// all scans before, and by closing loops.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "algo/map_move.hpp"
#include "algo/mapping/loop_watch.hpp"
#include "algo/mapping/map_localizer.hpp"
#include "algo/mapping/mapper_settings.hpp"
#include "algo/mapping/occupancy_map.hpp"
#include "algo/mapping/scan_matcher.hpp"
#include "algo/mapping/station_graph.hpp"
#include "algo/types.hpp"

namespace algo {

/// On known ground, scans are matched to one map that is never forgotten, so that a place that the
/// robot comes back to lies where it lay. A filter weighs each match against the wheels and learns
/// their scale: over a few metres the pose must be as smooth as theirs, since a doorway beside the
/// robot, out of its scanner's sight, is remembered in that frame.
///
/// On new ground, scans are matched to the map of the last metres alone, which begins with the
/// known walls around, and that map is added to the old one later. Once the scans fit the old map
/// too, the robot is back on known ground. If it fits elsewhere than the way says, a loop is
/// closed: the map moves, and the pose jumps. Unlike GraphMapper it keeps no scans, and moves the
/// map as it is.
///
/// A scan is matched only to walls that face as its points do. With both faces of a thin wall in
/// the map, the line through all points lies between them, or there is no line.
///
/// Memory grows with the area seen and not with the way driven. The same input gives the same poses
/// bit for bit.
class ScanOdometry {
 public:
  explicit ScanOdometry(const MapperSettings& settings = {});

  /// Forgets the map. The robot stands at `start_W`, and `odometry` is its pose by the wheels, in a
  /// frame of its own.
  void reset(const Pose2& start_W, const Pose2& odometry);

  /// Takes a scan of a robot at the odometry pose `odometry`: the returns `points_R` of a scanner
  /// at `scanner_R`. Only scans 0.1 m apart are matched, or 0.1 rad. Returns how the map moved, if
  /// the scan closed a loop.
  std::optional<MapMove> take(std::span<const Vec2> points_R,
                              const Vec2& scanner_R,
                              const Pose2& odometry);

  /// The pose of a robot at the odometry pose `odometry`.
  Pose2 pose_W(const Pose2& odometry) const {
    return compose(place_.pose_M(), scaled(pose_step(odometry_, odometry), place_.scale()));
  }
  /// Without the last metres of new ground.
  const OccupancyMap& map() const { return map_; }
  std::size_t stations() const { return stations_.size(); }

 private:
  /// A map of new ground, from station `first` on.
  struct Growing {
    OccupancyMap map;
    std::size_t first = 0;
    double way = 0;  // [m]
  };

  bool on_known_ground() const { return growing_.empty(); }
  void keep_near(std::span<const Vec2> points_R);
  void match();
  std::optional<MapMove> go_on(double way);
  void leave_known_ground();
  void grow(double way);
  std::optional<MapMove> come_back(const Pose2& seen_W);
  MapMove close_loop();
  void draw(MapMove& move) const;
  void enter(const Vec2& scanner_R);

  MapperSettings settings_{};
  OccupancyMap map_;
  std::vector<Growing> growing_{};  // the older first; none on known ground
  StationGraph stations_{};
  LoopWatch loop_watch_{};
  ScanMatcher matcher_{};
  FacedPoints scan_R_{};
  PlaceFilter place_;
  Pose2 odometry_{};                  // at the newest scan
  std::optional<Pose2> entered_W_{};  // the pose of the last scan in the map
};

}  // namespace algo
