// algo/full_strip/planner.hpp: the deliberative layer: plans a path to the goal on the local map.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "algo/full_strip/local_map.hpp"
#include "algo/recycled.hpp"
#include "algo/types.hpp"

namespace algo {

/// A* on a lattice of 0.1 m, from the goal to the robot, in bounded portions.
///
/// A step costs its length x (1 + 3 ((0.7 - d) / 0.5)^2) for a clearance d below 0.7 m. Below the
/// least clearance there is no way, except at the robot, which may stand anywhere.
class Planner {
 public:
  enum class State : std::uint8_t { Idle, Searching, Found, NoWay };

  Planner();
  void reset() { state_ = State::Idle; }

  /// Begins a search. The nearest place with room replaces a goal without room; a place on the
  /// border replaces a goal outside the map. With `try_tight`, a goal without room right before the
  /// robot is kept: the map's error may account for the missing room.
  void start(const LocalMap& map,
             const Vec2& robot_W,
             const Vec2& goal_W,
             double least_clearance,
             bool try_tight);
  /// Expands up to `budget` lattice points.
  State search(const LocalMap& map, int budget);

  State state() const { return state_; }
  /// True if the path ends away from the requested goal because an obstacle stands there.
  bool goal_taken() const { return goal_taken_; }
  /// True if the goal was kept although it has no room.
  bool goal_tight() const { return goal_tight_; }
  /// The path found, robot first. At most one point per lattice step.
  void path(Recycled<Vec2>& out) const;

  /// Cost [m per m] of motion with clearance `d` [m].
  static double unit_cost(double d);

 private:
  static constexpr int kSize = LocalMap::kSize / 2;
  static constexpr double kStep = 2 * LocalMap::kCell;  // [m]
  /// A point waiting to be expanded; the entries of a bucket are chained.
  struct Entry {
    std::uint32_t point = 0;
    std::uint32_t next = 0;  // entry + 1; 0: the last
  };
  std::uint32_t point_at(const Vec2& p_W) const;
  Vec2 position_W(std::uint32_t point) const;
  double clearance(const LocalMap& map, std::uint32_t point) const;
  bool near_robot(std::uint32_t point) const;
  float heuristic(std::uint32_t point) const;
  void push(std::uint32_t point, float g, std::uint8_t towards);
  std::optional<std::uint32_t> pop();
  float cost_of(const LocalMap& map, std::uint32_t point);
  std::uint32_t free_point(const LocalMap& map, std::uint32_t wanted) const;
  void expand(const LocalMap& map, std::uint32_t point);

  State state_ = State::Idle;
  bool goal_taken_ = false;
  bool goal_tight_ = false;
  double least_clearance_ = 0;
  Vec2 corner_W_{0, 0};
  Vec2 robot_W_{0, 0};
  Vec2 goal_W_{0, 0};
  std::uint32_t robot_ = 0;
  std::uint32_t root_ = 0;
  std::uint32_t round_ = 0;                     // of the search; data of earlier rounds is void
  std::vector<std::uint32_t> opened_, closed_;  // the last round in which a point was
  std::vector<float> g_;                        // [m]
  std::vector<std::uint8_t> towards_;           // the neighbour on the way to the goal
  std::vector<std::uint32_t> costed_;           // the round in which cost_ was found
  std::vector<float> cost_;                     // [m per m]; negative: no way
  // A queue of buckets kBucket wide. Costs rise along a search, so the first filled bucket is near.
  std::vector<std::uint32_t> buckets_;  // entry + 1
  std::vector<Entry> entries_;
  std::size_t bucket_ = 0;
};

/// Removes points of `path` wherever the straight line past them keeps `room` [m]. This removes the
/// lattice's corners in open space.
void straighten(const LocalMap& map, double room, Recycled<Vec2>& path);

}  // namespace algo
