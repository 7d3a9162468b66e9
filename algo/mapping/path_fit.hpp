// algo/mapping/path_fit.hpp: fits the poses of all key scans to all submaps that they saw.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "algo/laser_scan.hpp"
#include "algo/mapping/loop_closer.hpp"
#include "algo/mapping/pose_graph.hpp"
#include "algo/types.hpp"

namespace algo {

/// A scan that entered the map.
struct KeyScan {
  std::size_t scan = 0;                                   // its number in the log
  std::size_t submap = 0;                                 // that it was matched to
  Pose2 pose{};                                           // in it
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  // of that match
  Pose2 step{};  // by the odometry, from the key scan before
};

struct KeyPath {
  std::vector<KeyScan> scans{};
  std::vector<std::size_t> first{};  // key scan at which each submap began: its frame
};

/// Poses of all key scans. `graph` has a pose of each submap, `loops` the submaps; `scans` are
/// those of the log.
std::vector<Pose2> fit_path(const KeyPath& keys,
                            const PoseGraph& graph,
                            const LoopCloser& loops,
                            std::span<const LaserScan> scans,
                            double reach);

}  // namespace algo
