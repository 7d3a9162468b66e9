// algo/full_strip/planner.cpp: the search.
#include "algo/full_strip/planner.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <new>

#include "algo/full_strip/roomiest.hpp"

namespace algo {
namespace {

struct Move {
  int x = 0, y = 0;
  float length = 0;  // [m] on the fine lattice
};
constexpr float kStraight = 0.1F;
constexpr float kDiagonal = 0.14142136F;
constexpr std::array<Move, 8> kMoves{{{1, 0, kStraight},
                                      {1, 1, kDiagonal},
                                      {0, 1, kStraight},
                                      {-1, 1, kDiagonal},
                                      {-1, 0, kStraight},
                                      {-1, -1, kDiagonal},
                                      {0, -1, kStraight},
                                      {1, -1, kDiagonal}}};
constexpr float kAcross = 1.5F;           // fine steps between a fine and a coarse point
constexpr float kCoarseStep = 2;          // fine steps between coarse points
constexpr double kAtRobot = 0.3;          // [m] around the robot, where every point may be left
constexpr float kLeaving = 8;             // [m per m] if there is too little room
constexpr float kBucket = 0.05F;          // [m]
constexpr std::size_t kBuckets = 32'768;  // 1.6 km; costlier points share the last
constexpr std::size_t kMostEntries = 2'000'000;  // then nothing farther is searched
constexpr int kSearchFree = 15;       // lattice steps: the largest distance of a replaced goal
constexpr int kAroundSeen = 20;       // coarse cells around all that was seen
constexpr int kMostCoarse = 480;      // coarse cells from the robot
constexpr double kLenientRoom = 0.2;  // [m] clearance of a narrow place that may be looked at,
constexpr double kFromAfar = 0.05;    // [m] more beyond the local map
constexpr float kUnsure = 30;         // [m per m] there
constexpr int kExactCost = 3;         // of the budget
constexpr double kUnseenRoom = 0.05;  // [m] more, for an unseen goal

}  // namespace

Planner::Planner()
    : points_(static_cast<Point*>(std::calloc(kCount, sizeof(Point)))), buckets_(kBuckets) {
  if (points_ == nullptr) throw std::bad_alloc();
  entries_.reserve(kMostEntries);
}

Planner::Id Planner::coarse_id(Cell c) const {
  constexpr unsigned kMask = kCoarse - 1;
  return kFineCount + (static_cast<unsigned>(c.row) & kMask) * kCoarse +
         (static_cast<unsigned>(c.column) & kMask);
}

/// The cell that shares the memory of `coarse` and is nearest to the robot.
Planner::Cell Planner::cell_of(Id coarse) const {
  constexpr unsigned kMask = kCoarse - 1;
  constexpr int kToMiddle = kFine / 4;  // of the map, in coarse cells
  const Cell first{corner_.column + kToMiddle - kCoarse / 2, corner_.row + kToMiddle - kCoarse / 2};
  const unsigned place = coarse - kFineCount;
  const auto turned = [&](unsigned at, int from) {
    return from + static_cast<int>((at - static_cast<unsigned>(from)) & kMask);
  };
  return {turned(place % kCoarse, first.column), turned(place / kCoarse, first.row)};
}

Planner::Id Planner::id_at(const Vec2& p_W) const {
  const Vec2 p = (p_W - corner_W_) / kStep;
  const double most = kFine * 100.0;
  const int column = static_cast<int>(std::floor(std::clamp(p.x(), -most, most)));
  const int row = static_cast<int>(std::floor(std::clamp(p.y(), -most, most)));
  return is_inner(column, row) ? fine_id(column, row) : coarse_id(BuildingMemory::cell_of(p_W));
}

Vec2 Planner::position_W(Id id) const {
  if (!is_fine(id)) return BuildingMemory::middle_W(cell_of(id));
  const Id row = id / kFine;
  return corner_W_ + Vec2((id % kFine + 0.5) * kStep, (row + 0.5) * kStep);
}

/// The point, emptied if an earlier search wrote it.
Planner::Point& Planner::at(Id id) {
  Point& point = points_[id];
  if (point.round != round_) point = Point{.round = round_};
  return point;
}

/// [m] Of a fine point: at the corner that its four cells share. Of a coarse one: the most that is
/// remembered of its cell, as if all were free where nothing is.
double Planner::clearance(const PlanWorld& world, Id id) const {
  if (!is_fine(id)) {
    const std::uint8_t cm = world.memory.clearance(cell_of(id));
    return cm == BuildingMemory::kUnknown ? LocalMap::kReach : cm * 0.01;
  }
  const int column = static_cast<int>(id % kFine) * 2;
  const int row = static_cast<int>(id / kFine) * 2;
  return corner_distance(world.map, column, row);
}

bool Planner::near_robot(Id id) const {
  return (position_W(id) - robot_W_).squaredNorm() < kAtRobot * kAtRobot;
}

/// Octile distance to the robot: a lower bound of the cost.
float Planner::heuristic(Id id) const {
  const Vec2 d = (position_W(id) - robot_W_).cwiseAbs() / kStep;
  const auto low = static_cast<float>(d.minCoeff());
  const auto high = static_cast<float>(d.maxCoeff());
  return kStraight * (high - low) + kDiagonal * low;
}

void Planner::push(Id id, float g, Id parent) {
  if (entries_.size() == kMostEntries) return;
  Point& point = at(id);
  point.g = g;
  point.parent = parent;
  const auto bucket = static_cast<std::size_t>((g + heuristic(id)) / kBucket);
  const std::size_t place = std::clamp(bucket, bucket_, kBuckets - 1);
  entries_.push_back({id, buckets_[place]});
  buckets_[place] = static_cast<std::uint32_t>(entries_.size());
}

/// One of the cheapest waiting points.
std::optional<Planner::Id> Planner::pop() {
  while (bucket_ < kBuckets && buckets_[bucket_] == 0) ++bucket_;
  if (bucket_ == kBuckets) return std::nullopt;
  const Entry entry = entries_[buckets_[bucket_] - 1];
  buckets_[bucket_] = entry.next;
  return entry.point;
}

/// Cost [m per m] of a step to the point; negative if there is no way.
float Planner::cost_of(const PlanWorld& world, Id id) {
  Point& point = at(id);
  if (point.cost == 0) point.cost = new_cost(world, id);
  return point.cost;
}

float Planner::new_cost(const PlanWorld& world, Id id) {
  double d = clearance(world, id);
  if (options_.exact && is_fine(id) && is_doubtful(d, options_.cost.least)) {
    spent_ += kExactCost;
    d = roomiest(world.map, position_W(id), kAside, LocalMap::kReach).distance;
  }
  const Cell cell = is_fine(id) ? BuildingMemory::cell_of(position_W(id)) : cell_of(id);
  if (d < options_.cost.least) {
    if (near_robot(id)) return kLeaving;
    const double room = kLenientRoom + (is_fine(id) ? 0 : kFromAfar);
    return options_.lenient && d >= room && !world.memory.seen_near(cell) ? kUnsure : -1;
  }
  const double price = world.memory.seen(cell) ? 1 : StepCost::kUnseen;
  const double doubt = world.memory.doubtful(cell) ? StepCost::kDoubt : 0;
  return static_cast<float>(price * options_.cost.of(d) + doubt);
}

/// True if the goal may lie at the point. An unseen one needs more room: it may be the inside of a
/// thing.
bool Planner::has_room(const PlanWorld& world, Id id) const {
  const double d = clearance(world, id);
  const Vec2 p_W = position_W(id);
  if (!world.memory.seen(BuildingMemory::cell_of(p_W)))
    return d >= options_.cost.least + kUnseenRoom;
  if (d >= options_.cost.least) return true;
  return options_.exact && is_fine(id) &&
         roomiest(world.map, goal_W_, kAside, LocalMap::kReach).distance >= options_.cost.least;
}

/// The nearest point with room to stand, preferably a seen one. An unseen point may be the inside
/// of the obstacle on the goal, and the robot would drive all around it to find out.
Planner::Id Planner::free_point(const PlanWorld& world, Id wanted) const {
  if (!is_fine(wanted)) return wanted;
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
      if (!nearer || clearance(world, id) < options_.cost.least) continue;
      least = far;
      best = id;
      best_seen = seen;
    }
  }
  return best;
}

/// The coarse lattice ends where nothing was seen: farther ways through unseen space are as good.
void Planner::place_bounds(const BuildingMemory& memory) {
  const Cell robot = BuildingMemory::cell_of(robot_W_);
  const Cell goal = BuildingMemory::cell_of(goal_W_);
  const auto low = [](int seen, int a, int b) {
    return std::max(std::min({seen, a, b}) - kAroundSeen, a - kMostCoarse);
  };
  const auto high = [](int seen, int a, int b) {
    return std::min(std::max({seen, a, b}) + kAroundSeen, a + kMostCoarse);
  };
  low_ = {low(memory.low().column, robot.column, goal.column),
          low(memory.low().row, robot.row, goal.row)};
  high_ = {high(memory.high().column, robot.column, goal.column),
           high(memory.high().row, robot.row, goal.row)};
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
    if (way > kFarthest) share = std::min(share, kFarthest / way);
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
  place_bounds(world.memory);
  entries_.clear();
  std::ranges::fill(buckets_, 0U);
  bucket_ = 0;
  closest_W_ = goal_W_;
  push(root_, 0, root_);
  state_ = State::Searching;
}

Planner::State Planner::search(const PlanWorld& world, int budget) {
  if (state_ == State::Searching && corner_W_ != world.map.corner_W()) state_ = State::Idle;
  if (state_ != State::Searching) return state_;
  for (spent_ = 0; spent_ < budget; ++spent_) {
    const std::optional<Id> next = pop();
    if (!next) return state_ = State::NoWay;
    Point& point = at(*next);
    if (point.closed) {
      --spent_;
      continue;
    }
    point.closed = true;
    const Vec2 here_W = position_W(*next);
    if ((here_W - robot_W_).squaredNorm() < (closest_W_ - robot_W_).squaredNorm()) {
      closest_W_ = here_W;
    }
    if (*next == robot_) return state_ = State::Found;
    if (is_fine(*next)) {
      expand_fine(world, *next);
    } else {
      expand_coarse(world, *next);
    }
  }
  return state_;
}

/// Opens `to`, a neighbour of `from`, if no better way to it is known.
void Planner::relax(const PlanWorld& world, Id from, Id to, float length) {
  Point& point = at(to);
  if (point.closed) return;
  const float cost = cost_of(world, to);
  if (cost < 0) return;
  const float g = points_[from].g + length * cost;
  if (point.g >= 0 && point.g <= g) return;
  push(to, g, from);
}

void Planner::expand_fine(const PlanWorld& world, Id id) {
  const int column = static_cast<int>(id % kFine);
  const int row = static_cast<int>(id / kFine);
  for (const Move& move : kMoves) {
    const int x = column + move.x;
    const int y = row + move.y;
    if (is_inner(x, y)) {
      relax(world, id, fine_id(x, y), move.length);
    } else {
      const Cell cell{corner_.column + x / 2, corner_.row + y / 2};
      relax(world, id, coarse_id(cell), kAcross * move.length);
    }
  }
}

void Planner::expand_coarse(const PlanWorld& world, Id id) {
  const Cell from = cell_of(id);
  for (const Move& move : kMoves) {
    const Cell cell{from.column + move.x, from.row + move.y};
    if (cell.column < low_.column || cell.row < low_.row || cell.column >= high_.column ||
        cell.row >= high_.row) {
      continue;
    }
    const float length = kCoarseStep * move.length;
    const int x = 2 * (cell.column - corner_.column);
    const int y = 2 * (cell.row - corner_.row);
    if (!is_inner(x, y)) {
      relax(world, id, coarse_id(cell), length);
      continue;
    }
    for (const int v : {0, 1}) {
      for (const int u : {0, 1}) relax(world, id, fine_id(x + u, y + v), length);
    }
  }
}

void Planner::path(const PlanWorld& world, Path& out) const {
  out.points_W.clear();
  out.local = 0;
  out.beyond = 0;
  out.unsure = false;
  if (state_ != State::Found) return;
  out.points_W.push_back(robot_W_);
  bool local = true;
  Id id = robot_;
  for (; id != root_; id = points_[id].parent) {
    const Id next = points_[id].parent;
    out.unsure = out.unsure || points_[next].cost == kUnsure;
    Vec2 p_W = position_W(next);
    if (options_.exact && is_fine(next) &&
        clearance(world, next) < options_.cost.half_width + StepCost::kEasy) {
      p_W = roomiest(world.map, p_W, kAside, LocalMap::kReach).p_W;
    }
    if (local && !is_fine(next)) {
      local = false;
      out.local = out.points_W.size();
      out.beyond = static_cast<double>(points_[id].g);
    }
    out.points_W.push_back(p_W);
  }
  if (out.points_W.size() > 1) {
    out.points_W.back() = goal_W_;
  } else {
    out.points_W.push_back(goal_W_);
  }
  if (local) out.local = out.points_W.size();
}

std::optional<double> Planner::cost_from(const Vec2& p_W) const {
  const Point& point = points_[id_at(p_W)];
  if (point.round != round_ || point.g < 0) return std::nullopt;
  return static_cast<double>(point.g);
}

void straighten(const LocalMap& map, double room, Recycled<Vec2>& path) {
  const std::size_t size = path.size();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < size;) {
    path[kept++] = path[i];
    std::size_t next = i + 1;
    if (map.distance(path[i]) >= room) {
      while (next + 1 < size && map.sees(path[i], path[next + 1], room)) ++next;
    }
    i = next;
  }
  while (path.size() > kept) path.pop_back();
}

}  // namespace algo
