// algo/mapping/step_edges.cpp: covariances of odometry and information of matches.
#include "algo/mapping/step_edges.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace algo {
namespace {

// Odometry: random errors beside those of the scale.
constexpr double kWayNoise = 0.05;      // [m per square root of m]
constexpr double kTurnNoise = 0.05;     // [rad per square root of rad]
constexpr double kWayTurnNoise = 0.02;  // [rad per square root of m]
constexpr double kLeastWay = 0.002;     // [m] of each step
constexpr double kLeastTurn = 0.001;    // [rad]
constexpr double kOdometryDoubt = 6;    // wheels that slip on the spot

// Matches: neighbouring points err alike, so that each counts for less than its own noise says.
constexpr double kPointVariance = 0.01;  // [m2]
constexpr double kArm = 5;               // [m] at which a turn compares with a shift
constexpr double kSlack = 0.04;          // share of the points that tells nothing

constexpr double kBendWay = 0.05;   // [m] of a submap from end to end
constexpr double kBendTurn = 0.01;  // [rad]

}  // namespace

Pose2 scaled(const Pose2& step, const OdometryScale& scale) {
  return {(1 + scale.distance) * step.x,
          (1 + scale.distance) * step.y,
          (1 + scale.turn) * step.heading};
}

Eigen::Matrix3d step_covariance(const Pose2& step) {
  const double length = step.position().norm();
  const double turn = std::abs(step.heading);
  const double way_variance = kLeastWay * kLeastWay + kWayNoise * kWayNoise * length;
  const double turn_variance = kLeastTurn * kLeastTurn + kTurnNoise * kTurnNoise * turn +
                               kWayTurnNoise * kWayTurnNoise * length;
  return Vec3(way_variance, way_variance, turn_variance).asDiagonal();
}

void OdometryChain::add(const Pose2& step) {
  const double c = std::cos(step_.heading);
  const double s = std::sin(step_.heading);
  Eigen::Matrix2d r;
  r << c, -s, s, c;
  const Vec2 way = r * step.position();
  const Vec2 across(-way.y(), way.x());
  // Along a step the robot turns evenly, so its end is bent by half of the turn.
  bend_ += (turned_ + step.heading / 2) * across;
  Eigen::Matrix3d carry = Eigen::Matrix3d::Identity();
  carry(0, 2) = across.x();
  carry(1, 2) = across.y();
  covariance_ = carry * covariance_ * carry.transpose();
  covariance_ += step_covariance(step);
  turned_ += step.heading;
  step_ = compose(step_, step);
}

GraphEdge OdometryChain::edge(std::size_t from, std::size_t to) const {
  return {.from = from,
          .to = to,
          .step = step_,
          .information = covariance_.inverse(),
          .by_distance = {step_.x, step_.y, 0},
          .by_turn = {bend_.x(), bend_.y(), turned_},
          .doubt = kOdometryDoubt};
}

Eigen::Matrix3d match_information(const ScanMatch& match) {
  const Eigen::Vector3d unit(1, 1, 1 / kArm);
  const Eigen::Matrix3d points = unit.asDiagonal() * match.points * unit.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(points);
  const double slack = kSlack * (points(0, 0) + points(1, 1));
  const Eigen::Vector3d told = (eigen.eigenvalues().array() - slack).max(0) / kPointVariance;
  const Eigen::Matrix3d information =
      eigen.eigenvectors() * told.asDiagonal() * eigen.eigenvectors().transpose();
  const Eigen::Vector3d back(1, 1, kArm);
  return back.asDiagonal() * information * back.asDiagonal();
}

Eigen::Matrix3d weakened(const Eigen::Matrix3d& information, const Vec3& errors) {
  const Eigen::Matrix3d more = errors.cwiseAbs2().asDiagonal();
  // The inverse of the sum of both covariances, also where the match tells nothing.
  const Eigen::Matrix3d weaker =
      (Eigen::Matrix3d::Identity() + information * more).inverse() * information;
  return (weaker + weaker.transpose()) / 2;
}

Eigen::Matrix3d loop_information(const Eigen::Matrix3d& information) {
  return weakened(information, {kBendWay, kBendWay, kBendTurn});
}

bool complete(const Eigen::Matrix3d& information) {
  const Eigen::Vector3d unit(1, 1, 1 / kArm);
  const Eigen::Matrix3d even = unit.asDiagonal() * information * unit.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(even, Eigen::EigenvaluesOnly);
  return eigen.eigenvalues()(0) > 0.1 / kPointVariance;
}

}  // namespace algo
