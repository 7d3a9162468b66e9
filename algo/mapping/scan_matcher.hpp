// algo/mapping/scan_matcher.hpp: finds the pose at which a robot's scan lies on the walls of a map.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "algo/laser_scan.hpp"
#include "algo/mapping/facing.hpp"
#include "algo/types.hpp"

namespace algo {

/// A piece of wall in a map.
struct Surface {
  Vec2 on_W{0, 0};      // [m] a point on it
  Vec2 normal_W{1, 0};  // unit
};

/// Weighted moments of neighbouring points, and the line through them.
class SurfaceFit {
 public:
  void add(const Vec2& point, double weight);
  /// The least-squares line; nothing if the points are too few or too round a cluster.
  std::optional<Surface> line() const;

 private:
  std::size_t count_ = 0;
  double weight_ = 0;
  Vec2 sum_{0, 0};
  double xx_ = 0, xy_ = 0, yy_ = 0;
};

/// The weight of the odometry, as a number of points that agree with it.
struct MatchPrior {
  double position = 4;  // points
  double heading = 8;   // points x m2
};

struct ScanMatch {
  Pose2 pose_W{};    // of R
  double share = 0;  // of the scan's points that found a surface
  /// Normal matrix of x, y and heading by the points alone [points, points m2], of W about the
  /// pose.
  Eigen::Matrix3d points = Eigen::Matrix3d::Zero();
};

/// The poses of a search about a guess: half extents and steps.
struct SearchGrid {
  double window = 0.6;        // [m]
  double step = 0.1;          // [m]
  double turn_window = 0.26;  // [rad]
  double turn_step = 0.02;    // [rad]
};

/// Point-to-line ICP (Chen and Medioni 1992; Censi 2008), after a correlative search if the
/// odometry is too far off (Olson 2009). Minimises over the pose of R
///
///   sum_i rho(n_i . (T p_i - c_i)) + prior: w_p |t - t0|^2 + w_h (heading - heading0)^2
///
/// with (c_i, n_i) the line through the map's points around T p_i, found anew in each step, in
/// squares that shrink; rho is Geman and McClure's. Allocates only while scans grow. The same input
/// gives the same pose bit for bit.
///
/// A Map has `each_near(p_W, reach, see)`: LocalMap, OccupancyMap and Submap. If it knows how its
/// walls face, it has `each_facing(p_W, facing_W, reach, see)` too.
class ScanMatcher {
 public:
  /// Takes the scan to match: its Ok beams up to `reach` [m], thinned to kSpacing apart, so that
  /// near walls do not outweigh far ones.
  void take(const LaserScan& scan, double reach);
  /// Takes points of R instead of a scan, and thins them likewise.
  void take(const FacedPoints& points_R);
  /// Takes points of R of which nobody knows how they face.
  void take(std::span<const Vec2> points_R);
  std::span<const Vec2> points() const { return points_R_; }
  /// Mean of the points taken, in R.
  Vec2 middle() const;

  /// The pose near `guess_W` at which the scan fits the map best; `guess_W` itself if the map
  /// constrains nothing.
  template <typename Map>
  ScanMatch match(const Map& map, const Pose2& guess_W, const MatchPrior& prior) const;

  /// The pose on the grid about `guess_W` at which most points lie on the map: coarse, as the start
  /// of a match.
  template <typename Map>
  Pose2 search(const Map& map, const Pose2& guess_W, const SearchGrid& grid = {}) const;

 private:
  static constexpr double kSpacing = 0.08;                           // [m] between two points
  static constexpr std::size_t kFewest = 20;                         // points
  static constexpr std::array<double, 3> kReaches{0.5, 0.25, 0.15};  // [m] half edge of the square
  static constexpr int kIterations = 8;                              // at most, per reach
  static constexpr double kSettled = 1e-4;                           // [m] and [rad]
  static constexpr std::size_t kSearched = 3;  // a search uses every third point

  /// Normal equations of one Gauss-Newton step about `pose_W`.
  class Step {
   public:
    Step(const Pose2& pose_W, const Pose2& guess_W, const MatchPrior& prior);
    void add(const Vec2& p_W, const Surface& surface, double scale);
    /// The pose after one step; the same pose if the equations are singular.
    Pose2 taken() const;
    std::size_t used() const { return used_; }
    const Eigen::Matrix3d& points() const { return points_; }

   private:
    Pose2 pose_W_{};
    Eigen::Matrix3d prior_ = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d points_ = Eigen::Matrix3d::Zero();
    Eigen::Vector3d g_ = Eigen::Vector3d::Zero();
    std::size_t used_ = 0;
  };

  /// The surface that point `i` of the scan, at `p_W`, may lie on.
  template <typename Map>
  std::optional<Surface> surface_near(
      const Map& map, const Vec2& p_W, std::size_t i, double heading, double reach) const {
    SurfaceFit fit;
    const auto see = [&](const Vec2& point_W) {
      const double near = 1 - (point_W - p_W).squaredNorm() / (reach * reach);
      if (near > 0) fit.add(point_W, near);
    };
    if constexpr (requires { map.each_facing(p_W, Facing{}, reach, see); }) {
      const Facing facing_W = facings_R_.empty() ? Facing{} : facings_R_[i].turned(heading);
      map.each_facing(p_W, facing_W, reach, see);
    } else {
      map.each_near(p_W, reach, see);
    }
    return fit.line();
  }

  /// The number of search points with map points in the square of half edge `reach` [m] about them.
  template <typename Map>
  std::size_t lying_on(const Map& map, const Pose2& pose_W, double reach) const;

  FacedPoints scan_R_{};
  std::vector<Vec2> points_R_{};
  std::vector<Facing> facings_R_{};  // of each point, or none
};

template <typename Map>
ScanMatch ScanMatcher::match(const Map& map, const Pose2& guess_W, const MatchPrior& prior) const {
  ScanMatch found{.pose_W = guess_W};
  if (points_R_.size() < kFewest) return found;
  for (const double reach : kReaches) {
    for (int k = 0; k < kIterations; ++k) {
      Step step(found.pose_W, guess_W, prior);
      for (std::size_t i = 0; i < points_R_.size(); ++i) {
        const Vec2 p_W = to_parent(found.pose_W, points_R_[i]);
        const auto surface = surface_near(map, p_W, i, found.pose_W.heading, reach);
        if (surface) step.add(p_W, *surface, reach / 3);
      }
      found.share = static_cast<double>(step.used()) / static_cast<double>(points_R_.size());
      if (step.used() < kFewest) return {.pose_W = guess_W, .share = found.share};
      found.points = step.points();
      const Pose2 before = std::exchange(found.pose_W, step.taken());
      const double moved = (found.pose_W.position() - before.position()).norm();
      const double turned = std::abs(wrap_angle(found.pose_W.heading - before.heading));
      if (moved < kSettled && turned < kSettled) break;
    }
  }
  return found;
}

template <typename Map>
std::size_t ScanMatcher::lying_on(const Map& map, const Pose2& pose_W, double reach) const {
  std::size_t count = 0;
  for (std::size_t k = 0; k < points_R_.size(); k += kSearched) {
    bool met = false;
    map.each_near(to_parent(pose_W, points_R_[k]), reach, [&](const Vec2&) { met = true; });
    count += met ? 1 : 0;
  }
  return count;
}

template <typename Map>
Pose2 ScanMatcher::search(const Map& map, const Pose2& guess_W, const SearchGrid& grid) const {
  const int turns = static_cast<int>(grid.turn_window / grid.turn_step);
  const int steps = static_cast<int>(grid.window / grid.step);
  Pose2 best = guess_W;
  std::size_t most = lying_on(map, guess_W, grid.step / 2);
  for (int a = -turns; a <= turns; ++a) {
    for (int i = -steps; i <= steps; ++i) {
      for (int j = -steps; j <= steps; ++j) {
        const Pose2 pose_W{guess_W.x + i * grid.step,
                           guess_W.y + j * grid.step,
                           wrap_angle(guess_W.heading + a * grid.turn_step)};
        const std::size_t count = lying_on(map, pose_W, grid.step / 2);
        if (count <= most) continue;
        most = count;
        best = pose_W;
      }
    }
  }
  return best;
}

}  // namespace algo
