// algo/mapping/path_fit.cpp: ties of single scans to submaps, and their least squares.
#include "algo/mapping/path_fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "algo/mapping/scan_matcher.hpp"
#include "algo/mapping/step_edges.hpp"

namespace algo {
namespace {

constexpr double kMatchDoubt = 5;
constexpr double kTieDoubt = 4;
constexpr std::size_t kTieSpacing = 2;  // every n-th key scan is tied to other submaps
constexpr std::size_t kMostTies = 3;    // of one scan
constexpr double kTieApart = 8;         // [m] between the middles of a scan and a submap
constexpr std::size_t kTieGap = 2;      // submaps between two ties, since neighbours share scans
constexpr double kTieMove = 0.6;        // [m] by which a tie may move a scan
constexpr double kLeastTie = 0.5;       // share of the scan's points on the submap
constexpr int kRounds = 2;
constexpr MatchPrior kTiePrior{.position = 1, .heading = 2};

class PathFit {
 public:
  PathFit(const KeyPath& keys,
          const LoopCloser& loops,
          std::span<const LaserScan> scans,
          double reach)
      : keys_(keys), loops_(loops), scans_(scans), reach_(reach) {}

  /// Odometry and matches of the front end, from `keys_W` on.
  PoseGraph along(const std::vector<Pose2>& keys_W) const {
    PoseGraph graph;
    for (const Pose2& pose_W : keys_W) graph.add(pose_W);
    for (std::size_t k = 1; k < keys_W.size(); ++k) {
      const KeyScan& key = keys_.scans[k];
      OdometryChain odometry;
      odometry.add(key.step);
      graph.add(odometry.edge(k - 1, k));
      graph.add({.from = keys_.first[key.submap],
                 .to = k,
                 .step = key.pose,
                 .information = key.information,
                 .doubt = kMatchDoubt});
    }
    return graph;
  }

  void add_loops(PoseGraph& graph) const {
    for (const Loop& loop : loops_.closed()) {
      graph.add({.from = keys_.first[loop.earlier],
                 .to = keys_.first[loop.later],
                 .step = loop.step,
                 .information = loop.information,
                 .doubt = kTieDoubt});
    }
  }

  /// Matches key scans to submaps near them, from their poses in `graph` on.
  void add_ties(PoseGraph& graph) {
    for (std::size_t k = 0; k < keys_.scans.size(); k += kTieSpacing) {
      const LaserScan& scan = scans_[keys_.scans[k].scan];
      matcher_.take(scan, reach_);
      const Vec2 middle_W = to_parent(graph.pose(k), matcher_.middle());
      for (const std::size_t submap : submaps_near(graph, k, middle_W)) tie(graph, k, submap);
    }
  }

 private:
  std::vector<std::size_t> submaps_near(const PoseGraph& graph,
                                        std::size_t key,
                                        const Vec2& middle_W) const {
    std::vector<std::pair<double, std::size_t>> near;
    for (std::size_t s = 0; s < keys_.first.size(); ++s) {
      const bool own = keys_.first[s] <= key && key < end_of(s);
      if (own || s == keys_.scans[key].submap) continue;
      const Vec2 centre_W = to_parent(graph.pose(keys_.first[s]), loops_.submaps()[s].centre());
      const double apart = (centre_W - middle_W).norm();
      if (apart < kTieApart) near.emplace_back(apart, s);
    }
    std::ranges::sort(near);
    std::vector<std::size_t> chosen;
    for (const auto& [apart, s] : near) {
      const bool fresh = std::ranges::none_of(chosen, [s = s](std::size_t other) {
        return std::max(s, other) - std::min(s, other) < kTieGap;
      });
      if (fresh) chosen.push_back(s);
      if (chosen.size() == kMostTies) break;
    }
    return chosen;
  }

  /// The key scan after the last one that entered submap `s`.
  std::size_t end_of(std::size_t s) const {
    return s + 2 < keys_.first.size() ? keys_.first[s + 2] : keys_.scans.size();
  }

  void tie(PoseGraph& graph, std::size_t key, std::size_t submap) {
    const std::size_t anchor = keys_.first[submap];
    const Pose2 guess = pose_step(graph.pose(anchor), graph.pose(key));
    const ScanMatch match = matcher_.match(loops_.submaps()[submap], guess, kTiePrior);
    const bool moved = (match.pose_W.position() - guess.position()).norm() > kTieMove;
    if (match.share < kLeastTie || moved) return;
    graph.add({.from = anchor,
               .to = key,
               .step = match.pose_W,
               .information = match_information(match),
               .doubt = kTieDoubt});
  }

  const KeyPath& keys_;
  const LoopCloser& loops_;
  std::span<const LaserScan> scans_;
  double reach_ = 0;  // [m]
  ScanMatcher matcher_{};
};

std::vector<Pose2> poses_of(const PoseGraph& graph) {
  std::vector<Pose2> out;
  for (std::size_t k = 0; k < graph.size(); ++k) out.push_back(graph.pose(k));
  return out;
}

}  // namespace

std::vector<Pose2> fit_path(const KeyPath& keys,
                            const PoseGraph& graph,
                            const LoopCloser& loops,
                            std::span<const LaserScan> scans,
                            double reach) {
  std::vector<Pose2> keys_W;
  keys_W.reserve(keys.scans.size());
  for (const KeyScan& key : keys.scans) {
    keys_W.push_back(compose(graph.pose(key.submap), key.pose));
  }
  PathFit fit(keys, loops, scans, reach);
  for (int round = 0; round <= kRounds; ++round) {
    PoseGraph all = fit.along(keys_W);
    fit.add_loops(all);
    if (round > 0) fit.add_ties(all);
    all.solve();
    keys_W = poses_of(all);
  }
  return keys_W;
}

}  // namespace algo
