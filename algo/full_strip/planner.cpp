// algo/full_strip/planner.cpp: the search.
#include "algo/full_strip/planner.hpp"

#include <algorithm>
#include <array>
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
constexpr std::size_t kMostEntries = 2'000'000;  // for the least lattice; then it ends
constexpr double kLenientRoom = 0.2;  // [m] clearance of a narrow place that may be looked at,
constexpr double kFromAfar = 0.05;    // [m] more beyond the local map
constexpr float kUnsure = 30;         // [m per m] there
constexpr double kDrivenRoom = 0.1;   // [m] clearance below which it is shut all the same
constexpr float kDriven = 20;         // [m per m] in a narrow place that the robot has passed
constexpr int kExactCost = 3;         // of the budget

}  // namespace

Planner::Planner() : buckets_(kBuckets) {
  allocate(kCoarse);
}

/// Makes the coarse lattice `coarse` points wide.
void Planner::allocate(int coarse) {
  coarse_ = coarse;
  farthest_ = farthest_on(coarse);
  const auto side = static_cast<std::size_t>(coarse);
  points_.reset(static_cast<Point*>(std::calloc(kFineCount + side * side, sizeof(Point))));
  if (points_ == nullptr) throw std::bad_alloc();
  entries_.reserve(kMostEntries * side / kCoarse);
  round_ = 0;
  reset();
}

void Planner::hold(const DrawnSpace& drawn) {
  int coarse = kCoarse;
  const double longest = std::max(drawn.columns(), drawn.rows()) * DrawnSpace::kCell;
  while (coarse < kMostCoarse && farthest_on(coarse) < longest) coarse *= 2;
  if (coarse != coarse_) allocate(coarse);
}

Planner::Id Planner::coarse_id(Cell c) const {
  const unsigned mask = static_cast<unsigned>(coarse_) - 1;
  return kFineCount + (static_cast<unsigned>(c.row) & mask) * static_cast<unsigned>(coarse_) +
         (static_cast<unsigned>(c.column) & mask);
}

/// The cell that shares the memory of `coarse` and is nearest to the robot.
Planner::Cell Planner::cell_of(Id coarse) const {
  constexpr int kToMiddle = kFine / 4;  // of the map, in coarse cells
  const auto side = static_cast<unsigned>(coarse_);
  const Cell first{corner_.column + kToMiddle - coarse_ / 2, corner_.row + kToMiddle - coarse_ / 2};
  const unsigned place = coarse - kFineCount;
  const auto turned = [side](unsigned at, int from) {
    return from + static_cast<int>((at - static_cast<unsigned>(from)) & (side - 1));
  };
  return {turned(place % side, first.column), turned(place / side, first.row)};
}

Planner::Id Planner::id_at(const Vec2& p_W) const {
  const Vec2 p = (p_W - corner_W_) / kStep;
  const double most = kFine * 100.0;
  const int column = whole_below(std::clamp(p.x(), -most, most));
  const int row = whole_below(std::clamp(p.y(), -most, most));
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

Planner::Cell Planner::coarse_of(Id id) const {
  if (!is_fine(id)) return cell_of(id);
  return coarse_at(static_cast<int>(id % kFine), static_cast<int>(id / kFine));
}

/// [m] The clearance by own sight, and by the map where there is none.
double Planner::room(const PlanWorld& world, Id id) const {
  const double d = clearance(world, id);
  const Cell cell = coarse_of(id);
  if (world.drawn == nullptr || world.memory.seen(cell)) return d;
  return std::min(d, world.drawn_room(cell).value_or(d));
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
  if (entries_.size() == entries_.capacity()) return;
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
  const Cell cell = coarse_of(id);
  const StepCost& cost = options_.cost;
  if (d < cost.least) {
    if (near_robot(id)) return kLeaving;
    // Where the robot has been, there is room: a scan of a jamb errs by more than what is left.
    if (d >= kDrivenRoom && world.memory.driven(cell)) return kDriven;
    if (d < kLenientRoom + (is_fine(id) ? 0 : kFromAfar)) return -1;
    return options_.lenient && !world.memory.seen_near(cell) ? kUnsure : -1;
  }
  const double doubt = world.memory.doubtful(cell) ? StepCost::kDoubt : 0;
  if (world.memory.seen(cell)) return static_cast<float>(cost.of(d) + doubt);
  const std::optional<double> drawn = world.drawn_room(cell);
  if (!drawn) {
    const double price = world.drawn == nullptr ? StepCost::kUnseen : StepCost::kUndrawn;
    return static_cast<float>(price * cost.of(d) + doubt);
  }
  const bool shut = *drawn < cost.least;
  if (shut && options_.walls == DrawnWalls::Shut) return near_robot(id) ? kLeaving : -1;
  const double wall = shut ? StepCost::kDrawnWall : 0;
  return static_cast<float>(StepCost::kDrawn * cost.of(std::min(d, *drawn)) + doubt + wall);
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
      relax(world, id, coarse_id(coarse_at(x, y)), kAcross * move.length);
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

}  // namespace algo
