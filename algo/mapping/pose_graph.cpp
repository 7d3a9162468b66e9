// algo/mapping/pose_graph.cpp: normal equations of a pose graph, and their solution.
#include "algo/mapping/pose_graph.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/SparseCholesky>

namespace algo {
namespace {

constexpr double kScaleDeviation = 0.05;  // of an odometry's scale, before anything is measured
constexpr int kMostSteps = 40;
constexpr double kStepSettled = 1e-5;  // [m] and [rad]
constexpr double kNarrowing = 0.5;     // of the kernel, per iteration
constexpr double kTiny = 1e-9;         // keeps undetermined poses where they are

using Jacobian = Eigen::Matrix3d;

/// Derivatives of pose_step(from, to) by both poses.
struct StepSlopes {
  Jacobian by_from = Jacobian::Zero();
  Jacobian by_to = Jacobian::Zero();
};

StepSlopes slopes(const Pose2& from_W, const Pose2& to_W) {
  const double c = std::cos(from_W.heading);
  const double s = std::sin(from_W.heading);
  const Vec2 step = to_child(from_W, to_W.position());
  StepSlopes out;
  out.by_from << -c, -s, step.y(), s, -c, -step.x(), 0, 0, -1;
  out.by_to << c, s, 0, -s, c, 0, 0, 0, 1;
  return out;
}

}  // namespace

struct PoseGraph::Solver {
  Eigen::SparseMatrix<double> h{};
  Eigen::VectorXd g{};
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors{};
  std::vector<Eigen::Triplet<double>> triplets{};

  template <typename Block>
  void add(Eigen::Index row, Eigen::Index column, const Block& block) {
    if (row < 0 || column < 0) return;
    for (Eigen::Index i = 0; i < block.rows(); ++i) {
      for (Eigen::Index j = 0; j < block.cols(); ++j) {
        if (row + i >= column + j) triplets.emplace_back(row + i, column + j, block(i, j));
      }
    }
  }
};

namespace {

/// Place of a pose among the unknowns; below 0 for the first, which is fixed.
Eigen::Index unknown(std::size_t node) {
  return 3 * static_cast<Eigen::Index>(node) - 3;
}

}  // namespace

PoseGraph::PoseGraph() : solver_(std::make_unique<Solver>()) {}
PoseGraph::~PoseGraph() = default;
PoseGraph::PoseGraph(PoseGraph&&) noexcept = default;
PoseGraph& PoseGraph::operator=(PoseGraph&&) noexcept = default;

std::size_t PoseGraph::add(const Pose2& pose_W) {
  poses_W_.push_back(pose_W);
  factorised_ = false;
  return poses_W_.size() - 1;
}

void PoseGraph::add(const GraphEdge& edge) {
  edges_.push_back(edge);
  factorised_ = false;
}

Vec3 PoseGraph::residual(const GraphEdge& edge) const {
  const Pose2 step = pose_step(poses_W_[edge.from], poses_W_[edge.to]);
  const Vec3 scaled = scale_.distance * edge.by_distance + scale_.turn * edge.by_turn;
  return {step.x - edge.step.x - scaled.x(),
          step.y - edge.step.y - scaled.y(),
          wrap_angle(step.heading - edge.step.heading - scaled.z())};
}

double PoseGraph::distance(const GraphEdge& edge) const {
  const Vec3 e = residual(edge);
  return std::sqrt(std::max(0.0, e.dot(edge.information * e)));
}

double PoseGraph::weight(const GraphEdge& edge, double widening) const {
  if (edge.doubt <= 0) return 1;
  const double ratio = distance(edge) / (edge.doubt * widening);
  const double root = 1 / (1 + ratio * ratio);
  return root * root;
}

bool PoseGraph::factorise(double widening) {
  Solver& solver = *solver_;
  const auto scales = unknown(poses_W_.size());
  const Eigen::Index size = scales + 2;
  solver.triplets.clear();
  solver.g = Eigen::VectorXd::Zero(size);
  for (Eigen::Index k = 0; k < scales; ++k) solver.triplets.emplace_back(k, k, kTiny);
  const double prior = 1 / (kScaleDeviation * kScaleDeviation);
  solver.triplets.emplace_back(scales, scales, prior);
  solver.triplets.emplace_back(scales + 1, scales + 1, prior);
  solver.g(scales) = prior * scale_.distance;
  solver.g(scales + 1) = prior * scale_.turn;
  for (const GraphEdge& edge : edges_) {
    const StepSlopes by = slopes(poses_W_[edge.from], poses_W_[edge.to]);
    const Eigen::Matrix3d w = weight(edge, widening) * edge.information;
    const Vec3 we = w * residual(edge);
    const Eigen::Index from = unknown(edge.from);
    const Eigen::Index to = unknown(edge.to);
    solver.add(from, from, (by.by_from.transpose() * w * by.by_from).eval());
    solver.add(to, to, (by.by_to.transpose() * w * by.by_to).eval());
    const Eigen::Matrix3d mixed = by.by_from.transpose() * w * by.by_to;
    if (from > to) {
      solver.add(from, to, mixed);
    } else {
      solver.add(to, from, mixed.transpose().eval());
    }
    if (from >= 0) solver.g.segment<3>(from) += by.by_from.transpose() * we;
    if (to >= 0) solver.g.segment<3>(to) += by.by_to.transpose() * we;
    if (edge.by_distance.isZero() && edge.by_turn.isZero()) continue;
    Eigen::Matrix<double, 3, 2> by_scale;
    by_scale << -edge.by_distance, -edge.by_turn;
    solver.add(scales, scales, (by_scale.transpose() * w * by_scale).eval());
    solver.add(scales, from, (by_scale.transpose() * w * by.by_from).eval());
    solver.add(scales, to, (by_scale.transpose() * w * by.by_to).eval());
    solver.g.segment<2>(scales) += by_scale.transpose() * we;
  }
  solver.h.resize(size, size);
  solver.h.setFromTriplets(solver.triplets.begin(), solver.triplets.end());
  solver.factors.compute(solver.h);
  factorised_ = solver.factors.info() == Eigen::Success;
  return factorised_;
}

double PoseGraph::step() {
  const Eigen::VectorXd x = solver_->factors.solve(-solver_->g);
  factorised_ = false;
  if (!x.allFinite()) return 0;
  for (std::size_t node = 1; node < poses_W_.size(); ++node) {
    const auto by = x.segment<3>(unknown(node));
    Pose2& pose = poses_W_[node];
    pose = {pose.x + by.x(), pose.y + by.y(), wrap_angle(pose.heading + by.z())};
  }
  scale_.distance += x(x.size() - 2);
  scale_.turn += x(x.size() - 1);
  return x.cwiseAbs().maxCoeff();
}

void PoseGraph::solve() {
  if (poses_W_.size() < 2) return;
  double widening = 1;
  for (const GraphEdge& edge : edges_) {
    if (edge.doubt > 0) widening = std::max(widening, 2 * distance(edge) / edge.doubt);
  }
  for (int k = 0; k < kMostSteps; ++k) {
    if (!factorise(widening)) return;
    const double moved = step();
    if (widening <= 1 && moved < kStepSettled) return;
    widening = std::max(1.0, kNarrowing * widening);
  }
}

Eigen::Matrix3d PoseGraph::covariance(std::size_t from, std::size_t to) {
  if (!factorised_ && !factorise(1)) return Eigen::Matrix3d::Identity();
  const StepSlopes by = slopes(poses_W_[from], poses_W_[to]);
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(solver_->h.rows(), 3);
  if (from > 0) rows.middleRows<3>(unknown(from)) = by.by_from.transpose();
  if (to > 0) rows.middleRows<3>(unknown(to)) = by.by_to.transpose();
  return rows.transpose() * solver_->factors.solve(rows);
}

}  // namespace algo
