// algo/map_move.hpp: the robot's own map, drawn anew after a loop of its way was closed.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "algo/drawn_space.hpp"
#include "algo/types.hpp"

namespace algo {

/// A place of the way. What was seen from it moves with it, as a rigid body.
struct StationMove {
  Pose2 from_W{};
  Pose2 to_W{};
  Vec2 moved(const Vec2& p_W) const { return to_parent(to_W, to_child(from_W, p_W)); }
  double turn() const { return wrap_angle(to_W.heading - from_W.heading); }  // [rad]
};

/// A map drawn along a way is bent as the way was measured. Once the robot recognises a place, the
/// way is measured anew, and all of the map moves with it, as does the robot.
struct MapMove {
  Pose2 from_W{};  // of the robot before,
  Pose2 to_W{};    // and now

  /// The places that the way passes. Not empty.
  std::vector<StationMove> stations{};
  /// The point `p_W` of the way, moved with the station nearest to it.
  Vec2 moved(const Vec2& p_W) const {
    const auto far = [&](const StationMove& station) {
      return (station.from_W.position() - p_W).squaredNorm();
    };
    return std::ranges::min_element(stations, {}, far)->moved(p_W);
  }

  /// The map after the move.
  std::vector<Eigen::Vector2f> walls_W{};  // [m]
  /// A cell of edge DrawnSpace::kCell through which beams passed.
  struct Seen {
    int column = 0, row = 0;
    std::uint8_t beams = 0;  // at most 255
  };
  std::vector<Seen> seen{};

  /// The point of the map about the robot that lies at `p_W` now, where it lay before.
  Vec2 moved_back(const Vec2& p_W) const { return to_parent(from_W, to_child(to_W, p_W)); }
};

}  // namespace algo
