// algo/mapping/graph_mapper.hpp: finds the path of a robot from its scans and its odometry.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "algo/laser_scan.hpp"
#include "algo/mapping/loop_closer.hpp"
#include "algo/mapping/mapper_settings.hpp"
#include "algo/mapping/occupancy_map.hpp"
#include "algo/mapping/path_fit.hpp"
#include "algo/mapping/pose_graph.hpp"
#include "algo/mapping/scan_matcher.hpp"
#include "algo/mapping/step_edges.hpp"
#include "algo/types.hpp"

namespace algo {

/// Matches each scan to the submap of the last metres, closes loops between submaps, and at the end
/// fits all poses to all matches (graph SLAM; Grisetti et al. 2010, Hess et al. 2016).
///
/// A new submap starts every half of `submap`, and scans are matched to the older of the two that
/// grow, so that a scan always meets a map with some metres in it.
class GraphMapper {
 public:
  explicit GraphMapper(const MapperSettings& settings) : settings_(settings) {}

  /// Takes a scan of a robot at the odometry pose `odometry_W`. Returns its pose by what is known
  /// so far; the first pose is that of the odometry.
  Pose2 add(const LaserScan& scan, const Pose2& odometry_W);

  /// The path through all scans taken, fitted to all matches. `scans` are the same ones again.
  std::vector<Pose2> finish(std::span<const LaserScan> scans);

  /// Nodes are submaps.
  const PoseGraph& graph() const { return graph_; }
  const LoopCloser& loops() const { return closer_; }
  /// [bytes] of the map: grows with the area seen and the way driven, not with the building.
  std::size_t bytes() const;

 private:
  /// A submap that still grows.
  struct Growing {
    std::size_t node = 0;
    OccupancyMap map;
    Pose2 pose{};    // of the robot in it
    double way = 0;  // [m] driven in it
  };
  /// Where a scan was, seen from the last key scan.
  struct Placed {
    std::size_t key = 0;
    Pose2 step{};
  };

  void follow(const LaserScan& scan, const Pose2& step);
  void match(const LaserScan& scan);
  void enter(const LaserScan& scan);
  void start_submap();
  void finish_submap();

  MapperSettings settings_{};
  ScanMatcher matcher_{};
  ScanMatch match_{};
  PoseGraph graph_{};  // of the submaps
  LoopCloser closer_{};
  std::vector<Growing> growing_{};  // the older first
  OdometryChain since_submap_{};    // since the newest submap began
  KeyPath keys_{};
  Pose2 key_pose_{};  // of the last one, in the older growing submap
  std::vector<Placed> placed_{};
  std::optional<Pose2> odometry_W_{};  // of the previous scan
  OdometryChain since_key_{};
};

}  // namespace algo
