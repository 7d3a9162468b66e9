// algo/mapping/station_graph.hpp: the way that a robot has driven, as a graph of stations.
#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "algo/mapping/occupancy_map.hpp"
#include "algo/mapping/pose_graph.hpp"
#include "algo/types.hpp"

namespace algo {

/// A station stands about every kApart of the way, tied to the stations next to it. A robot that
/// comes back passes the old stations again, so that the graph grows with the ground covered and
/// not with the way driven. A station behind a wall is not passed: it may belong to another part of
/// the way. Stations are numbered in their order.
class StationGraph {
 public:
  static constexpr double kApart = 2.0;  // [m] from one station to the next
  static constexpr double kAt = 1.2;     // [m] a robot nearer than this is at a station

  /// The robot stands at `start_W`, which is the first station, and stays where it is.
  void reset(const Pose2& start_W);
  /// The robot drove to `pose_W`, past the stations from number `first` on, which stand in `map`.
  /// True if it set up a new one.
  bool drive(const Pose2& pose_W, std::size_t first, const OccupancyMap& map);

  /// True if one of the stations before number `end` is within `reach` [m].
  bool any_near(const Vec2& p_W, std::size_t end, double reach) const;

  /// The robot, at `pose_W` by its way, is at `seen_W` by `map`, in which the stations before
  /// number `end` stand. True if the graph learns from that: it does once for two stations.
  bool recognise(const Pose2& pose_W,
                 const Pose2& seen_W,
                 std::size_t end,
                 const OccupancyMap& map);
  /// Fits the stations to all ties. Returns how each one moved, by its number.
  std::vector<StationMove> fit();

  /// The station passed last.
  std::size_t here() const { return here_; }
  std::size_t size() const { return graph_.size(); }

 private:
  std::optional<std::size_t> seen_from(const Vec2& p_W,
                                       std::size_t begin,
                                       std::size_t end,
                                       double reach,
                                       const OccupancyMap& map) const;
  bool tie(std::size_t from, std::size_t to, const Pose2& step, const Vec3& deviations);
  static Vec3 deviations_of(double way);

  PoseGraph graph_{};
  std::set<std::pair<std::size_t, std::size_t>> ties_{};
  std::size_t here_ = 0;
};

}  // namespace algo
