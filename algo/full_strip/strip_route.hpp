// algo/full_strip/strip_route.hpp: the way to the present goal: the planner's path, and the strip
// that lies along it.
#pragma once

#include <cstddef>
#include <optional>

#include "algo/full_strip/local_map.hpp"
#include "algo/full_strip/node_strip.hpp"
#include "algo/full_strip/planner.hpp"
#include "algo/recycled.hpp"
#include "algo/types.hpp"

namespace algo {

/// What the route needs to know of robot and parameters.
struct RouteSettings {
  StripSettings strip{};   // the least clearance is the route's own
  double half_width = 0;   // [m] of the hull
  double max_v = 0;        // [m/s]
  double break_room = 0;   // [m] the strip's clearance may fall this far below the planned
  double plan_period = 0;  // [s]
};

/// Lays the strip along the planner's path, fits it to the map each tick, and plans again where it
/// breaks or a new path is clearly better.
class StripRoute {
 public:
  /// Without a goal.
  void reset();
  /// Forgets everything about the way to the goal before.
  void set_goal(const Vec2& goal_W, double now);
  void clear_goal();
  const std::optional<Vec2>& goal_W() const { return goal_W_; }

  /// One tick, with a goal: fits the strip, and goes on with the search.
  void update(const RouteSettings& settings, const LocalMap& map, const Vec2& here_W, double now);
  /// Drops the strip and plans anew.
  void give_up(double now);

  const NodeStrip& strip() const { return strip_; }
  /// [m] along the strip to the place where it is broken; negative if it is whole.
  double broken_at() const { return broken_at_; }
  /// The map has no path to the goal, not even at the narrowest clearance.
  bool no_way() const { return no_way_; }
  /// True if an obstacle stands on the goal and the strip ends farther than `reach` [m] from it.
  bool goal_taken(double reach) const;
  /// The planner's latest path.
  const Recycled<Vec2>& path_W() const { return path_W_; }

 private:
  void ease_last_leg(const LocalMap& map, const Vec2& here_W);
  void stretch(const LocalMap& map, const Vec2& here_W, double now);
  void plan(const LocalMap& map, const Vec2& here_W, double now);
  void start_search(const LocalMap& map, const Vec2& here_W, double now);
  void take_plan(const LocalMap& map, const Vec2& here_W);
  bool is_better(const LocalMap& map, double nearer) const;
  double least_clearance() const;
  double left(const NodeStrip& strip) const;

  RouteSettings settings_{};
  Planner planner_{};
  NodeStrip strip_{};
  NodeStrip candidate_{};
  Recycled<Vec2> path_W_{};
  std::optional<Vec2> goal_W_{};
  std::size_t level_ = 0;  // of the planner's clearance; 0 is the widest
  bool no_way_ = false;
  bool goal_taken_ = false;
  std::optional<double> tight_since_{};  // [s] since when it tries for a goal without room
  double broken_at_ = -1;                // [m]
  double next_plan_ = 0;                 // [s] run clock
};

}  // namespace algo
