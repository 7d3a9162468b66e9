// algo/mapping/map_localizer.hpp: where a robot is on a known map, and how sure that is.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "algo/laser_scan.hpp"
#include "algo/map_pose.hpp"
#include "algo/mapping/place_search.hpp"
#include "algo/mapping/scan_matcher.hpp"
#include "algo/mapping/step_edges.hpp"
#include "algo/mapping/submap.hpp"
#include "algo/types.hpp"

namespace algo {

/// One place at which the robot may be: a Kalman filter over its pose on the map and the scale
/// errors of its odometry, corrected by matched scans.
class PlaceFilter {
 public:
  /// `deviation` [m] of x and y, `turn_deviation` [rad].
  PlaceFilter(const Pose2& pose_M, double deviation, double turn_deviation);

  /// Follows a step of the odometry.
  void follow(const Pose2& step);
  /// The scan fits far better at `other_M`: the odometry was wrong by as much.
  void doubt(const Pose2& other_M);
  /// Takes a match found from pose_M() on, of which the share `fit` of the points lies on walls.
  /// `map_errors`: the deviations [m], [m], [rad] of the map, which err alike in many matches in a
  /// row.
  void take(const ScanMatch& match, double fit, const Vec3& map_errors = known_map_errors());
  /// Of a map that somebody gave: it is bent, and things have moved since.
  static Vec3 known_map_errors();

  /// The map has moved under the robot, which is now at `pose_M`.
  void move(const Pose2& pose_M) { pose_M_ = pose_M; }

  const Pose2& pose_M() const { return pose_M_; }
  /// Of x, y [m] and heading [rad] in M.
  Eigen::Matrix3d covariance() const { return covariance_.topLeftCorner<3, 3>(); }
  const OdometryScale& scale() const { return scale_; }
  bool due() const;
  bool matched() const { return matched_; }
  /// Share of the points on walls, over the last metres.
  double fit() const { return fit_; }
  /// [m] Way since the place was found, weighed by the fit.
  double merit() const { return merit_; }

 private:
  using Matrix5 = Eigen::Matrix<double, 5, 5>;

  Pose2 pose_M_{};
  OdometryScale scale_{};
  Matrix5 covariance_;
  bool matched_ = false;
  double way_ = 0;  // [m] since the last match, a radian counting as a metre
  double fit_ = 0;
  double merit_ = 0;
};

/// Follows the robot on a map by matching its scans. It begins with a search: about the pose that
/// somebody gave, else everywhere. All places that fit about equally are followed until the way
/// tells them apart, so that between two corridors that look alike neither is believed. Where the
/// scans cease to fit, the place is not believed, and it looks about that place; if that lasts, it
/// searches everywhere.
///
/// Each call does a bounded piece of work and allocates nothing once the scans keep their size.
/// The same input gives the same poses bit for bit.
class MapLocalizer {
 public:
  explicit MapLocalizer(Submap map);

  /// As new: nothing is known of the odometry either.
  void restart();
  /// The robot is at `pose_M`, within 0.1 m or so.
  void start(const Pose2& pose_M);
  /// The robot is within kGivenWay and kGivenTurn of `guess_M`. Along a plain corridor it stays as
  /// unsure as that.
  void place(const Pose2& guess_M);
  /// The robot may be anywhere.
  void forget();

  /// Takes a scan of a robot that was at the odometry pose `odometry_W` in the middle of its
  /// sweep.
  void take(const LaserScan& scan, const Pose2& odometry_W);
  /// Likewise, and ends a search within this scan: for a log, which does not wait for it.
  void take_whole(const LaserScan& scan, const Pose2& odometry_W);

  MapFix fix() const;
  bool located() const { return fix() == MapFix::Located; }
  /// Places that fit.
  std::size_t places() const { return filters_.size(); }
  /// The place that fits best; valid where there is one.
  const PlaceFilter& best() const { return filters_.front(); }
  /// The fix in words.
  std::string sentence() const;
  const Submap& map() const { return map_; }

  static constexpr double kGivenWay = 2;     // [m]
  static constexpr double kGivenTurn = 0.5;  // [rad]

 private:
  void look_about();
  void begin_search(const Pose2& odometry_W);
  void end_search(const Pose2& odometry_W);
  void begin_places();
  bool better_found() const;
  void take_places(const Pose2& since);
  void take_places_about(const Pose2& guess_M, const Pose2& since);
  bool connected(const Pose2& a_M, const Pose2& b_M) const;
  void match_next();
  double fit_at(const Pose2& pose_M) const;
  void drop_worse();
  void watch(double way);
  double deviation() const;

  Submap map_;
  PlaceSearch search_;
  ScanMatcher matcher_{};
  std::vector<PlaceFilter> filters_{};  // the best first
  std::size_t next_ = 0;                // to be matched
  std::optional<Pose2> given_M_{};
  bool given_ = false;     // the places lie about a pose that somebody gave
  bool compared_ = false;  // the places found
  bool believed_ = false;  // the only place fits,
  bool located_ = false;   // and is known well enough to drive by it
  bool searching_ = false;
  bool wanted_ = true;        // a search
  double idle_ = 0;           // [m] way since a search that found nothing of use
  int idle_scans_ = 0;        // since then
  int unwatched_ = 0;         // scans since the place was last checked,
  double unwatched_way_ = 0;  // [m] and way
  int poor_ = 0;              // checks in a row at which the scan did not fit
  double astray_ = 0;         // [m] way in doubt since a search about the place
  bool about_ = false;        // the search is about the place, which stays if none is better
  std::optional<Pose2> odometry_W_{};
  Pose2 search_odometry_W_{};
};

}  // namespace algo
