// algo/mapping/loop_closer.hpp: recognises places that the robot has seen before, and decides which
// of these loops to believe.
#pragma once

#include <cstddef>
#include <vector>

#include "algo/mapping/loop_search.hpp"
#include "algo/mapping/pose_graph.hpp"
#include "algo/mapping/scan_matcher.hpp"
#include "algo/mapping/submap.hpp"

namespace algo {

/// Submap `later` seen from the older submap `earlier`, by their walls.
struct Loop {
  std::size_t earlier = 0, later = 0;
  Pose2 step{};
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  double fit = 0;  // share of the common walls that agree
};

/// Holds the finished submaps. Node k of the graph is the frame of submap k.
///
/// A loop within the metre that the graph leaves open is taken at once. A wider one could be
/// another place that looks alike. It waits until loops of several later submaps agree with it by
/// the way between them, and until no other set of loops agrees about as well; without such
/// agreement it is never taken. (Pairwise consistency: Mangelson et al. 2018.)
class LoopCloser {
 public:
  /// Takes the finished submap `k`, and closes what loops it can in `graph`. True if any.
  bool take(std::size_t k, Submap submap, PoseGraph& graph);

  const std::vector<Submap>& submaps() const { return submaps_; }
  const std::vector<Loop>& closed() const { return closed_; }

 private:
  struct Candidate {
    std::size_t earlier = 0;
    Pose2 guess{};
    SearchWindow window{};
    double apart = 0;       // [m] between the centres
    bool expected = false;  // to match, if the graph is right
    bool near() const;
  };
  std::vector<Candidate> candidates(std::size_t later, PoseGraph& graph) const;
  void search(std::size_t later, const Candidate& candidate, std::vector<Loop>& out);
  bool verify(Loop& loop);
  double surprise(const Loop& loop, PoseGraph& graph) const;
  bool close_near(std::size_t later, PoseGraph& graph);
  bool close_far(std::size_t later, PoseGraph& graph);
  bool agree(const Loop& a, const Loop& b, PoseGraph& graph) const;
  double support(const std::vector<std::size_t>& members) const;
  std::vector<std::size_t> best_of_each(const std::vector<std::size_t>& members) const;
  std::vector<Loop> believed(PoseGraph& graph) const;
  void close(const Loop& loop, PoseGraph& graph);

  std::vector<Submap> submaps_{};
  std::vector<Loop> pending_{};
  std::vector<Loop> closed_{};
  bool expected_ = false;  // the newest submap lies in a place known from long ago
  bool met_ = false;       // and matched it
  int misses_ = 0;         // such submaps in a row that matched none
  ScanMatcher matcher_{};
};

}  // namespace algo
