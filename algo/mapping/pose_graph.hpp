// algo/mapping/pose_graph.hpp: poses tied by measured steps, and the poses that fit them best.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "algo/types.hpp"

namespace algo {

/// A measured step between two poses of a graph. Its residual, in the frame of `from`:
///
///   e = pose_step(from, to) - (step + distance_scale by_distance + turn_scale by_turn)
struct GraphEdge {
  std::size_t from = 0, to = 0;
  Pose2 step{};
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  // of x, y and heading
  /// Change of `step` with the scale errors of the odometry; zero for what no wheel measured.
  Vec3 by_distance{0, 0, 0}, by_turn{0, 0, 0};
  /// Mahalanobis distance from which an edge counts as false (Geman and McClure); 0: never.
  double doubt = 0;
};

/// The scale errors of an odometry, as shares of the way and of the turn.
struct OdometryScale {
  double distance = 0, turn = 0;
};

/// Least squares over poses in the plane by Gauss-Newton and a sparse Cholesky factorisation
/// (Kuemmerle et al. 2011), with the scale errors of the odometry as two more unknowns.
///
/// A false edge must not bend the map. All edges with a `doubt` begin as good as trusted, and the
/// kernel narrows in each iteration to its final width (graduated non-convexity; Yang et al. 2020).
/// Serial, and in the order of the edges: the same input gives the same poses bit for bit.
class PoseGraph {
 public:
  PoseGraph();
  ~PoseGraph();
  PoseGraph(PoseGraph&&) noexcept;
  PoseGraph& operator=(PoseGraph&&) noexcept;

  /// Adds a pose. The first one stays where it is.
  std::size_t add(const Pose2& pose_W);
  void add(const GraphEdge& edge);

  std::size_t size() const { return poses_W_.size(); }
  const Pose2& pose(std::size_t node) const { return poses_W_[node]; }
  const std::vector<GraphEdge>& edges() const { return edges_; }
  const OdometryScale& scale() const { return scale_; }

  /// Moves the poses to the least sum of squares. Poses that cannot be determined stay.
  void solve();

  /// Covariance of pose_step(from, to), by the edges at the present poses.
  Eigen::Matrix3d covariance(std::size_t from, std::size_t to);

  /// Mahalanobis distance of the edge at the present poses.
  double distance(const GraphEdge& edge) const;

 private:
  struct Solver;

  Vec3 residual(const GraphEdge& edge) const;
  double weight(const GraphEdge& edge, double widening) const;
  bool factorise(double widening);
  double step();

  std::vector<Pose2> poses_W_{};
  std::vector<GraphEdge> edges_{};
  OdometryScale scale_{};
  std::unique_ptr<Solver> solver_;
  bool factorised_ = false;  // at the present poses and edges
};

}  // namespace algo
