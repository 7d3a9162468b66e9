// algo/full_strip/strip_route.hpp: the way to the present goal: the planner's path, and the strip
// that lies along it.
#pragma once

#include <cstdint>
#include <optional>

#include "algo/full_strip/node_strip.hpp"
#include "algo/full_strip/planner.hpp"
#include "algo/full_strip/step_cost.hpp"
#include "algo/recycled.hpp"
#include "algo/types.hpp"

namespace algo {

/// What the route needs to know of robot and parameters.
struct RouteSettings {
  StripSettings strip{};   // the least clearance is the route's own
  double half_width = 0;   // [m] of the hull
  bool round = false;      // the hull is a disc: half_width is all of it
  double max_v = 0;        // [m/s]
  double break_room = 0;   // [m] the strip's clearance may fall this far below the planned
  double plan_period = 0;  // [s]
};

/// Lays the strip along the planner's path, as far as that lies on the local map, fits it to the
/// map each tick, and plans again where it breaks or a new path is clearly better.
class StripRoute {
 public:
  /// Makes room for plans on the whole of a map. Allocates.
  void hold(const DrawnSpace& drawn) { planner_.hold(drawn); }
  /// Without a goal.
  void reset();
  /// Forgets everything about the way to the goal before.
  void set_goal(const Vec2& goal_W, double now);
  void clear_goal();
  const std::optional<Vec2>& goal_W() const { return goal_W_; }

  /// One tick, with a goal: fits the strip, and goes on with the search.
  void update(const RouteSettings& settings,
              const PlanWorld& world,
              const Vec2& here_W,
              double now);
  /// Drops the strip and plans anew.
  void give_up(double now);

  const NodeStrip& strip() const { return strip_; }
  /// [m] along the strip to the place where it is broken; negative if it is whole.
  double broken_at() const { return broken_at_; }
  /// The map has no path to the goal.
  bool no_way() const { return failures_ >= kSurely; }
  /// A search has just found no way, and the map should drop what it knows on little evidence.
  bool doubts() const { return doubts_; }
  /// Without a way, at the place to wait at: the point that the robot should look at.
  std::optional<Vec2> watched_W() const {
    return watch_ && strip_.empty() ? std::optional(watch_->at_W) : std::nullopt;
  }
  /// The search leads to the nearest place with room instead of the goal.
  bool goal_replaced() const { return planner_.goal_taken(); }
  /// By the map alone there is no way, so that the robot drives to see whether its walls are there.
  bool doubts_walls() const { return walls_ == DrawnWalls::Priced; }
  /// There is no strip yet, and the search goes on.
  bool waits_for_plan() const {
    return strip_.empty() && !no_way() && planner_.state() == Planner::State::Searching;
  }
  /// True if an obstacle stands on the goal and the strip ends farther than `reach` [m] from it.
  bool goal_taken(double reach) const;
  /// The planner's latest path.
  const Recycled<Vec2>& path_W() const { return path_.points_W; }

 private:
  // Searches in a row without a way. The first may have met a ghost on the map. From the third on
  // they are lenient.
  static constexpr int kSurely = 3;
  bool lenient() const { return failures_ >= kSurely - 1; }
  void ease_last_leg(const LocalMap& map, const Vec2& here_W);
  void stretch(const LocalMap& map, const Vec2& here_W, double now);
  void plan(const PlanWorld& world, const Vec2& here_W, double now);
  void start_search(const PlanWorld& world, const Vec2& here_W, double now);
  void take_plan(const PlanWorld& world, const Vec2& here_W);
  void fail(const PlanWorld& world, const Vec2& here_W, double now);
  void note_closure(const PlanWorld& world);
  void wait_for_way(const PlanWorld& world, const Vec2& here_W, double now);
  bool doubt_walls(const PlanWorld& world, const Vec2& here_W, double now);
  void search_for_watch(const PlanWorld& world, const Vec2& here_W);
  bool is_better(const LocalMap& map, bool was_taken) const;
  bool is_extended() const;
  StepCost step_cost() const;
  Planner::Options plan_options() const;
  double left(const NodeStrip& strip) const;

  RouteSettings settings_{};
  Planner planner_{};
  NodeStrip strip_{};
  NodeStrip candidate_{};
  Planner::Path path_{};
  Recycled<Vec2> line_W_{};  // the path's local part
  std::optional<Vec2> goal_W_{};
  /// A place to wait at for a way, and what to look at from there.
  struct Watch {
    Vec2 from_W{0, 0};
    Vec2 at_W{0, 0};
    std::optional<double> since{};  // [s] run clock: it is there
  };
  /// What the planner searches for: a way to the goal; all places within reach, of which the
  /// nearest to the goal is wanted; a way to the place to wait at.
  enum class Aim : std::uint8_t { Goal, Reach, Watch };
  Aim aim_ = Aim::Goal;
  std::optional<Watch> closure_{};  // a place that had been free for long and was then shut
  std::optional<Watch> watch_{};
  bool doubts_ = false;
  int failures_ = 0;  // searches in a row without a way
  DrawnWalls walls_ = DrawnWalls::Shut;
  double doubted_until_ = 0;  // [s] run clock: then the walls of the map count as shut again
  bool goal_taken_ = false;
  std::optional<double> tight_since_{};  // [s] since when it tries for a goal without room
  double broken_at_ = -1;                // [m]
  double next_plan_ = 0;                 // [s] run clock
};

}  // namespace algo
