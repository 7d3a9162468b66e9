// algo/mapping/station_graph.cpp: stations, their ties, and the moves of a fit.
#include "algo/mapping/station_graph.hpp"

#include <algorithm>
#include <cmath>

namespace algo {
namespace {

// What matched scans are off by along a metre of way.
constexpr double kWayError = 0.01;    // [m]
constexpr double kTurnError = 0.003;  // [rad]
constexpr double kShortest = 0.1;     // [m] of way that counts, however short the step
// What a place recognised is off by.
constexpr double kSeenError = 0.02;       // [m]
constexpr double kSeenTurnError = 0.004;  // [rad]
constexpr double kRecognised = 5;         // [m] from the farthest station that a place is tied to

}  // namespace

void StationGraph::reset(const Pose2& start_W) {
  graph_ = {};
  graph_.add(start_W);
  ties_.clear();
  here_ = 0;
}

Vec3 StationGraph::deviations_of(double way) {
  const double root = std::sqrt(kShortest + way);
  return {kWayError * root, kWayError * root, kTurnError * root};
}

/// False if the two are tied already.
bool StationGraph::tie(std::size_t from,
                       std::size_t to,
                       const Pose2& step,
                       const Vec3& deviations) {
  if (!ties_.insert(std::minmax(from, to)).second) return false;
  GraphEdge edge{.from = from, .to = to, .step = step};
  edge.information.diagonal() = deviations.cwiseAbs2().cwiseInverse();
  graph_.add(edge);
  return true;
}

/// The nearest of the stations from `begin` to `end` within `reach` [m] of `p_W` without a wall
/// between.
std::optional<std::size_t> StationGraph::seen_from(const Vec2& p_W,
                                                   std::size_t begin,
                                                   std::size_t end,
                                                   double reach,
                                                   const OccupancyMap& map) const {
  std::optional<std::size_t> found;
  double least = reach;
  for (std::size_t k = begin; k < end; ++k) {
    const Vec2 at_W = graph_.pose(k).position();
    const double far = (at_W - p_W).norm();
    if (far >= least || !map.sees(p_W, at_W)) continue;
    least = far;
    found = k;
  }
  return found;
}

bool StationGraph::drive(const Pose2& pose_W, std::size_t first, const OccupancyMap& map) {
  const Pose2 step = pose_step(graph_.pose(here_), pose_W);
  const double way = step.position().norm();
  if (const auto at = seen_from(pose_W.position(), first, graph_.size(), kAt, map)) {
    if (*at != here_) {
      tie(here_, *at, pose_step(graph_.pose(here_), graph_.pose(*at)), deviations_of(way));
    }
    here_ = *at;
    return false;
  }
  if (way < kApart || graph_.size() >= OccupancyMap::kMostStations) return false;
  const std::size_t station = graph_.add(pose_W);
  tie(here_, station, step, deviations_of(way));
  here_ = station;
  return true;
}

bool StationGraph::any_near(const Vec2& p_W, std::size_t end, double reach) const {
  for (std::size_t k = 0; k < end; ++k) {
    if ((graph_.pose(k).position() - p_W).squaredNorm() < reach * reach) return true;
  }
  return false;
}

bool StationGraph::recognise(const Pose2& pose_W,
                             const Pose2& seen_W,
                             std::size_t end,
                             const OccupancyMap& map) {
  const auto station = seen_from(seen_W.position(), 0, end, kRecognised, map);
  if (!station) return false;
  const Pose2 from_robot = pose_step(pose_W, graph_.pose(here_));
  const Pose2 step = pose_step(graph_.pose(*station), compose(seen_W, from_robot));
  return tie(*station, here_, step, {kSeenError, kSeenError, kSeenTurnError});
}

std::vector<StationMove> StationGraph::fit() {
  std::vector<StationMove> moves(graph_.size());
  for (std::size_t k = 0; k < graph_.size(); ++k) moves[k].from_W = graph_.pose(k);
  graph_.solve();
  for (std::size_t k = 0; k < graph_.size(); ++k) moves[k].to_W = graph_.pose(k);
  return moves;
}

}  // namespace algo
