// algo/mapping/scan_odometry.hpp: odometry whose drift is taken out by matching scans to the map of
// all scans before.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "algo/mapping/map_localizer.hpp"
#include "algo/mapping/mapper_settings.hpp"
#include "algo/mapping/occupancy_map.hpp"
#include "algo/mapping/scan_matcher.hpp"
#include "algo/types.hpp"

namespace algo {

/// Matches the robot's scans to one map that it never forgets, so that a place that it comes back
/// to lies where it lay. A filter weighs each match against the wheels and learns their scale: over
/// a few metres the pose must be as smooth as theirs, since a doorway beside the robot, out of its
/// scanner's sight, is remembered in that frame. Unlike GraphMapper it closes no loops, and the
/// drift of one way round a loop must stay below the reach of the matcher, 0.5 m.
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
  /// at `scanner_R`. Only scans 0.1 m apart are matched, or 0.1 rad.
  void take(std::span<const Vec2> points_R, const Vec2& scanner_R, const Pose2& odometry);

  /// The pose of a robot at the odometry pose `odometry`.
  Pose2 pose_W(const Pose2& odometry) const {
    return compose(place_.pose_M(), scaled(pose_step(odometry_, odometry), place_.scale()));
  }
  const OccupancyMap& map() const { return map_; }

 private:
  void keep_near(std::span<const Vec2> points_R);
  void enter(const Vec2& scanner_R);

  MapperSettings settings_{};
  OccupancyMap map_;
  ScanMatcher matcher_{};
  FacedPoints scan_R_{};
  PlaceFilter place_;
  Pose2 odometry_{};                  // at the newest scan
  std::optional<Pose2> entered_W_{};  // the pose of the last scan in the map
};

}  // namespace algo
