// server/lab/buildings/map_trueness.hpp: how much of the strip's map is drawn twice.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "algo/full_strip/strip_senses.hpp"
#include "algo/types.hpp"
#include "server/lab/buildings/grid_oracle.hpp"

namespace server::buildings {

/// The occupied cells of the strip's map and memory, as points of its frame W.
std::vector<algo::Vec2> remembered_walls(const algo::StripSenses& senses);

/// Pieces of a map, squares of kPiece, and where each piece lies in the true world by the robot's
/// newest visit.
class MapPieces {
 public:
  static constexpr double kPiece = 6.4;  // [m]

  /// The robot believes that it is at `believed_W`, and is at `true_W`.
  void visit(const algo::Pose2& believed_W, const algo::Pose2& true_W);
  /// The pose of W in the true world, by the newest visit of the piece of `p_W`, or of the nearest
  /// piece that was visited. The identity without any visit.
  algo::Pose2 pose_at(const algo::Vec2& p_W) const;
  using Place = std::pair<int, int>;  // column and row
  static Place place_of(const algo::Vec2& p_W);

 private:
  std::map<Place, algo::Pose2> poses_{};
};

/// The share of the points `walls_W` that lie farther than kApart from every true surface, once
/// each piece of the map is laid on the true world as well as it can be. A map that is bent or
/// moved as a whole has a small share. Where a wall is drawn twice, one of the two is off it,
/// however the piece is laid: of a map with every wall doubled about half is off. NaN without
/// points.
double doubled_share(const std::vector<algo::Vec2>& walls_W,
                     const MapPieces& pieces,
                     const GridOracle& truth);
inline constexpr double kApart = 0.10;  // [m]

}  // namespace server::buildings
