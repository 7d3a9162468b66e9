// algo/full_strip/planner_goal.cpp: where a search begins, and how far it may go.
#include <algorithm>
#include <cmath>
#include <limits>

#include "algo/full_strip/planner.hpp"
#include "algo/full_strip/roomiest.hpp"

namespace algo {
namespace {

constexpr int kSearchFree = 15;       // lattice steps: the largest distance of a replaced goal
constexpr int kSearchDrawn = 15;      // coarse cells: the same for a goal beyond the local map
constexpr double kUnseenRoom = 0.05;  // [m] more, for an unseen goal
constexpr int kAroundSeen = 20;       // coarse cells around all that was seen
constexpr int kRimCoarse = 32;        // coarse cells that a way keeps from the lattice's edge

}  // namespace

/// True if the goal may lie at the point. One that neither robot nor map has seen needs more room:
/// it may be the inside of a thing.
bool Planner::has_room(const PlanWorld& world, Id id) const {
  const double d = room(world, id);
  const Vec2 p_W = position_W(id);
  const Cell cell = BuildingMemory::cell_of(p_W);
  if (!world.memory.seen(cell)) {
    return d >= options_.cost.least + (world.drawn_room(cell) ? 0 : kUnseenRoom);
  }
  if (d >= options_.cost.least) return true;
  return options_.exact && is_fine(id) &&
         roomiest(world.map, goal_W_, kAside, LocalMap::kReach).distance >= options_.cost.least;
}

/// The nearest point with room to stand, preferably a seen one. An unseen point may be the inside
/// of the obstacle on the goal, and the robot would drive all around it to find out.
Planner::Id Planner::free_point(const PlanWorld& world, Id wanted) const {
  if (!is_fine(wanted)) return world.drawn == nullptr ? wanted : free_coarse(world, wanted);
  Id best = wanted;
  bool best_seen = false;
  double least = std::numeric_limits<double>::infinity();
  const int column = static_cast<int>(wanted % kFine);
  const int row = static_cast<int>(wanted / kFine);
  for (int y = row - kSearchFree; y <= row + kSearchFree; ++y) {
    for (int x = column - kSearchFree; x <= column + kSearchFree; ++x) {
      if (!is_inner(x, y)) continue;
      const Id id = fine_id(x, y);
      const bool seen = world.memory.seen(BuildingMemory::cell_of(position_W(id)));
      const double far = std::hypot(x - column, y - row);
      const bool nearer = seen == best_seen ? far < least : seen;
      if (!nearer || room(world, id) < options_.cost.least) continue;
      least = far;
      best = id;
      best_seen = seen;
    }
  }
  return best;
}

/// The same for a goal beyond the local map, on which a known map shows too little room.
Planner::Id Planner::free_coarse(const PlanWorld& world, Id wanted) const {
  const Cell middle = cell_of(wanted);
  Id best = wanted;
  int least = kSearchDrawn * kSearchDrawn + 1;  // squared distance
  for (int y = -kSearchDrawn; y <= kSearchDrawn; ++y) {
    for (int x = -kSearchDrawn; x <= kSearchDrawn; ++x) {
      const int far = x * x + y * y;
      const Cell cell{middle.column + x, middle.row + y};
      if (far >= least || is_fine(id_at(BuildingMemory::middle_W(cell)))) continue;
      const Id id = coarse_id(cell);
      const bool known = world.memory.seen(cell) || world.drawn_room(cell);
      if (!known || room(world, id) < options_.cost.least) continue;
      least = far;
      best = id;
    }
  }
  return best;
}

/// The coarse lattice ends where nothing was seen or drawn: farther ways through unseen space are
/// as good.
void Planner::place_bounds(const PlanWorld& world) {
  const Cell robot = BuildingMemory::cell_of(robot_W_);
  const Cell goal = BuildingMemory::cell_of(goal_W_);
  const int most = coarse_ / 2 - kRimCoarse;
  const auto low = [most](int seen, int a, int b) {
    return std::max(std::min({seen, a, b}) - kAroundSeen, a - most);
  };
  const auto high = [most](int seen, int a, int b) {
    return std::min(std::max({seen, a, b}) + kAroundSeen, a + most);
  };
  Cell least = world.memory.low();
  Cell most_seen = world.memory.high();
  if (world.drawn != nullptr) {
    const DrawnSpace& drawn = *world.drawn;
    least = {std::min(least.column, drawn.left()), std::min(least.row, drawn.bottom())};
    most_seen = {std::max(most_seen.column, drawn.left() + drawn.columns()),
                 std::max(most_seen.row, drawn.bottom() + drawn.rows())};
  }
  low_ = {low(least.column, robot.column, goal.column), low(least.row, robot.row, goal.row)};
  high_ = {high(most_seen.column, robot.column, goal.column),
           high(most_seen.row, robot.row, goal.row)};
}

void Planner::start(const PlanWorld& world,
                    const Vec2& robot_W,
                    const Vec2& goal_W,
                    const Options& options) {
  corner_W_ = world.map.corner_W();
  corner_ = BuildingMemory::cell_of(corner_W_ + Vec2(kStep, kStep));
  options_ = options;
  ++round_;
  robot_W_ = robot_W;
  robot_ = id_at(robot_W);
  double share = 1;
  for (int k = 0; k < 2; ++k) {
    const double way = std::abs(goal_W[k] - robot_W[k]);
    if (way > farthest_) share = std::min(share, farthest_ / way);
  }
  goal_W_ = robot_W + share * (goal_W - robot_W);
  root_ = id_at(goal_W_);
  goal_taken_ = false;
  const bool room = has_room(world, root_);
  goal_tight_ = !room && options.try_tight && near_robot(root_);
  if (!room && !goal_tight_) {
    const Id free = free_point(world, root_);
    goal_taken_ = share >= 1 && free != root_;
    root_ = free;
    if (goal_taken_) goal_W_ = position_W(root_);
  }
  place_bounds(world);
  entries_.clear();
  std::ranges::fill(buckets_, 0U);
  bucket_ = 0;
  closest_W_ = goal_W_;
  push(root_, 0, root_);
  state_ = State::Searching;
}

}  // namespace algo
