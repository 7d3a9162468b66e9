// algo/mapping/loop_search.hpp: finds where the walls of one submap lie on those of another,
// anywhere in a window.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "algo/mapping/submap.hpp"
#include "algo/mapping/wall_pyramid.hpp"
#include "algo/types.hpp"

namespace algo {

/// Half extents of a window about a guess.
struct SearchWindow {
  double x = 0, y = 0;  // [m]
  double heading = 0;   // [rad]
};

struct FoundPose {
  Pose2 pose{};
  double score = 0;  // 0 to 1: share of the points that lie on walls
};

/// Correlative search by branch and bound (Olson 2009; Hess et al. 2016). The pyramid bounds the
/// score, so that most of the window is never looked at and yet the best pose of all is found.
class LoopSearch {
 public:
  explicit LoopSearch(const Submap& walls);

  /// The pose of the frame of `points` at which most of them lie on the walls, at least
  /// `least_score`, not within `apart` [m] of a position in `known`. Nothing if there is none, or
  /// if the search takes too long because everything fits about equally.
  std::optional<FoundPose> best(std::span<const Vec2> points,
                                const Pose2& guess,
                                const SearchWindow& window,
                                double least_score,
                                std::span<const FoundPose> known = {},
                                double apart = 0) const;

 private:
  struct Turned {
    double heading = 0;
    std::vector<int> columns{}, rows{};  // of the points, at the window's corner
  };
  struct Branch {
    int turn = 0;
    int x = 0, y = 0;  // [cells] from the window's corner
    double score = 0;
  };
  struct Search;

  double score(const Turned& turned, std::size_t height, int x, int y) const;

  WallPyramid walls_;
};

}  // namespace algo
