// server/lab/mapping/path_error.cpp: pieces of 10 m, one from each pose.
#include "server/lab/mapping/path_error.hpp"

#include <cmath>
#include <stdexcept>

namespace server::mapping {
namespace {

constexpr double kPathPiece = 10;  // [m]

double way(const algo::Pose2& from_W, const algo::Pose2& to_W) {
  return (to_W.position() - from_W.position()).norm();
}

}  // namespace

double path_length(std::span<const algo::Pose2> path_W) {
  double length = 0;
  for (std::size_t i = 1; i < path_W.size(); ++i) length += way(path_W[i - 1], path_W[i]);
  return length;
}

PathError path_error(std::span<const algo::Pose2> true_W, std::span<const algo::Pose2> estimate_W) {
  if (true_W.size() != estimate_W.size()) {
    throw std::invalid_argument("the paths to compare are of different length");
  }
  PathError error;
  if (true_W.empty()) return error;
  error.end = way(true_W.back(), estimate_W.back());
  for (std::size_t i = 0; i < true_W.size(); ++i) {
    const double off = way(true_W[i], estimate_W[i]);
    error.rms += off * off / static_cast<double>(true_W.size());
  }
  error.rms = std::sqrt(error.rms);
  double square = 0;
  double turn_square = 0;
  double length = 0;  // [m] of the true path from i to j
  std::size_t j = 0;
  for (std::size_t i = 0; i < true_W.size(); ++i) {
    while (length < kPathPiece && j + 1 < true_W.size()) {
      length += way(true_W[j], true_W[j + 1]);
      ++j;
    }
    if (length < kPathPiece) break;
    const algo::Pose2 truth = algo::pose_step(true_W[i], true_W[j]);
    const algo::Pose2 estimate = algo::pose_step(estimate_W[i], estimate_W[j]);
    const double turn = algo::wrap_angle(estimate.heading - truth.heading);
    square += (estimate.position() - truth.position()).squaredNorm();
    turn_square += turn * turn;
    ++error.pieces;
    length -= way(true_W[i], true_W[i + 1]);
  }
  if (error.pieces == 0) return error;
  const auto count = static_cast<double>(error.pieces);
  error.rms_10m = std::sqrt(square / count);
  error.turn_10m = std::sqrt(turn_square / count);
  return error;
}

}  // namespace server::mapping
