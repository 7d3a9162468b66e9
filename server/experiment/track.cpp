// server/experiment/track.cpp: keeps the points that are far enough apart.
#include "server/experiment/track.hpp"

#include <algorithm>
#include <cmath>

namespace server::experiment {
namespace {

using algo::Vec2;

constexpr double kKeptSpacing = 0.05;  // [m]
constexpr double kMostPoints = 400;    // of a coarse track

double length(std::span<const Vec2> track_W) {
  double sum = 0;
  for (std::size_t i = 1; i < track_W.size(); ++i) sum += (track_W[i] - track_W[i - 1]).norm();
  return sum;
}

}  // namespace

std::vector<Vec2> thinned(std::span<const Vec2> track_W, double spacing) {
  std::vector<Vec2> kept_W;
  for (const Vec2& p_W : track_W) {
    if (kept_W.empty() || (p_W - kept_W.back()).norm() >= spacing) kept_W.push_back(p_W);
  }
  return kept_W;
}

std::vector<Vec2> coarse(std::span<const Vec2> track_W) {
  std::vector<Vec2> kept_W =
      thinned(track_W, std::max(kKeptSpacing, length(track_W) / kMostPoints));
  if (!kept_W.empty() && kept_W.back() != track_W.back()) kept_W.push_back(track_W.back());
  for (Vec2& p_W : kept_W) {
    p_W = {std::round(100 * p_W.x()) / 100, std::round(100 * p_W.y()) / 100};
  }
  return kept_W;
}

}  // namespace server::experiment
