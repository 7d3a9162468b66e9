// algo/mapping/step_edges.hpp: edges of a pose graph from odometry and from matched scans.
#pragma once

#include <Eigen/Core>

#include "algo/mapping/pose_graph.hpp"
#include "algo/mapping/scan_matcher.hpp"
#include "algo/types.hpp"

namespace algo {

/// `step` of an odometry with these scale errors, corrected.
Pose2 scaled(const Pose2& step, const OdometryScale& scale);

/// Covariance of x, y and heading of one step of an odometry, beside that of its scale.
Eigen::Matrix3d step_covariance(const Pose2& step);

/// The odometry's steps from one pose of a graph to the next, their covariance, and how they
/// change with the scale errors.
class OdometryChain {
 public:
  void add(const Pose2& step);
  GraphEdge edge(std::size_t from, std::size_t to) const;
  const Pose2& step() const { return step_; }

 private:
  Pose2 step_{};
  Vec2 bend_{0, 0};    // [m] derivative of the position by the turn's scale
  double turned_ = 0;  // [rad] not wrapped
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
};

/// Information of a match on x, y and heading. A direction in which few walls oppose a shift, as
/// along a corridor, counts as not measured: what the noise of the normals seems to tell there
/// would hold the pose where the odometry put it.
Eigen::Matrix3d match_information(const ScanMatch& match);

/// `information` of a match, if the map itself is off by `errors` (deviations [m], [m], [rad]).
Eigen::Matrix3d weakened(const Eigen::Matrix3d& information, const Vec3& errors);
/// `information` of a match between submaps, which are bent a little themselves. A loop has to be
/// weaker than the steps along the way, or a false one would break these and not itself.
Eigen::Matrix3d loop_information(const Eigen::Matrix3d& information);

/// Whether all of x, y and heading are measured.
bool complete(const Eigen::Matrix3d& information);

}  // namespace algo
