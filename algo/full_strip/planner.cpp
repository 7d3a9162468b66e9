// algo/full_strip/planner.cpp: the search.
#include "algo/full_strip/planner.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace algo {
namespace {

struct Move {
  int x = 0, y = 0;
  float length = 0;  // [m]
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
constexpr std::uint8_t kRoot = 255;
constexpr double kAtRobot = 0.3;        // [m] around the robot, where every point may be left
constexpr double kLeaving = 8;          // [m per m] if there is too little room
constexpr float kBucket = 0.02F;        // [m]
constexpr std::size_t kBuckets = 8192;  // 160 m; costlier points share the last
constexpr double kComfort = 0.7;        // [m] clearance above which more is not worth a detour
constexpr double kBorder = 0.5;         // [m] at the map's border, where no goal may lie
constexpr int kSearchFree = 15;         // lattice steps: the largest distance of a replaced goal

}  // namespace

Planner::Planner()
    : opened_(static_cast<std::size_t>(kSize) * kSize),
      closed_(opened_.size()),
      g_(opened_.size()),
      towards_(opened_.size()),
      costed_(opened_.size()),
      cost_(opened_.size()),
      buckets_(kBuckets) {
  entries_.reserve(4 * opened_.size());
}

double Planner::unit_cost(double d) {
  const double lacking = std::max(0.0, kComfort - d) / 0.5;
  return 1 + 3 * lacking * lacking;
}

std::uint32_t Planner::point_at(const Vec2& p_W) const {
  const Vec2 p = (p_W - corner_W_) / kStep;
  const auto column = static_cast<std::uint32_t>(std::clamp(p.x(), 1.0, kSize - 2.0));
  const auto row = static_cast<std::uint32_t>(std::clamp(p.y(), 1.0, kSize - 2.0));
  return row * kSize + column;
}

Vec2 Planner::position_W(std::uint32_t point) const {
  const std::uint32_t column = point % kSize;
  const std::uint32_t row = point / kSize;
  return corner_W_ + Vec2((column + 0.5) * kStep, (row + 0.5) * kStep);
}

/// [m] Clearance at the corner that the lattice point's four cells share.
double Planner::clearance(const LocalMap& map, std::uint32_t point) const {
  const int column = static_cast<int>(point % kSize) * 2;
  const int row = static_cast<int>(point / kSize) * 2;
  const int sum = map.cell_distance(column, row) + map.cell_distance(column + 1, row) +
                  map.cell_distance(column, row + 1) + map.cell_distance(column + 1, row + 1);
  return sum * 0.00025;
}

bool Planner::near_robot(std::uint32_t point) const {
  return (position_W(point) - robot_W_).squaredNorm() < kAtRobot * kAtRobot;
}

/// Octile distance to the robot: a lower bound of the cost.
float Planner::heuristic(std::uint32_t point) const {
  const int dx = std::abs(static_cast<int>(point % kSize) - static_cast<int>(robot_ % kSize));
  const int dy = std::abs(static_cast<int>(point / kSize) - static_cast<int>(robot_ / kSize));
  const auto low = static_cast<float>(std::min(dx, dy));
  const auto high = static_cast<float>(std::max(dx, dy));
  return kStraight * (high - low) + kDiagonal * low;
}

void Planner::push(std::uint32_t point, float g, std::uint8_t towards) {
  opened_[point] = round_;
  g_[point] = g;
  towards_[point] = towards;
  const auto bucket = static_cast<std::size_t>((g + heuristic(point)) / kBucket);
  const std::size_t at = std::clamp(bucket, bucket_, kBuckets - 1);
  entries_.push_back({point, buckets_[at]});
  buckets_[at] = static_cast<std::uint32_t>(entries_.size());
}

/// One of the cheapest waiting points.
std::optional<std::uint32_t> Planner::pop() {
  while (bucket_ < kBuckets && buckets_[bucket_] == 0) ++bucket_;
  if (bucket_ == kBuckets) return std::nullopt;
  const Entry entry = entries_[buckets_[bucket_] - 1];
  buckets_[bucket_] = entry.next;
  return entry.point;
}

/// Cost [m per m] of a step to `point`; negative if there is no way.
float Planner::cost_of(const LocalMap& map, std::uint32_t point) {
  if (costed_[point] == round_) return cost_[point];
  const double d = clearance(map, point);
  double cost = unit_cost(d);
  if (d < least_clearance_) cost = near_robot(point) ? kLeaving : -1;
  costed_[point] = round_;
  return cost_[point] = static_cast<float>(cost);
}

/// The nearest point with room to stand, preferably a seen one. An unseen point may be the inside
/// of the obstacle on the goal, and the robot would drive all around it to find out.
std::uint32_t Planner::free_point(const LocalMap& map, std::uint32_t wanted) const {
  std::uint32_t best = wanted;
  bool best_seen = false;
  double least = std::numeric_limits<double>::infinity();
  const int column = static_cast<int>(wanted % kSize);
  const int row = static_cast<int>(wanted / kSize);
  for (int y = std::max(1, row - kSearchFree); y <= std::min(kSize - 2, row + kSearchFree); ++y) {
    for (int x = std::max(1, column - kSearchFree); x <= std::min(kSize - 2, column + kSearchFree);
         ++x) {
      const auto point = static_cast<std::uint32_t>(y * kSize + x);
      const bool seen = map.seen().seen(position_W(point));
      const double far = std::hypot(x - column, y - row);
      const bool nearer = seen == best_seen ? far < least : seen;
      if (!nearer || clearance(map, point) < least_clearance_) continue;
      least = far;
      best = point;
      best_seen = seen;
    }
  }
  return best;
}

void Planner::start(const LocalMap& map,
                    const Vec2& robot_W,
                    const Vec2& goal_W,
                    double least_clearance,
                    bool try_tight) {
  corner_W_ = map.corner_W();
  least_clearance_ = least_clearance;
  robot_W_ = robot_W;
  robot_ = point_at(robot_W);
  goal_W_ = goal_W;
  // For a goal beyond the map: the place where the straight line to it leaves the map.
  const Vec2 low = corner_W_ + Vec2(kBorder, kBorder);
  const Vec2 high = corner_W_ + Vec2(kSize * kStep - kBorder, kSize * kStep - kBorder);
  double share = 1;
  for (int k = 0; k < 2; ++k) {
    const double way = goal_W[k] - robot_W[k];
    if (goal_W[k] > high[k]) share = std::min(share, (high[k] - robot_W[k]) / way);
    if (goal_W[k] < low[k]) share = std::min(share, (low[k] - robot_W[k]) / way);
  }
  goal_taken_ = false;
  goal_W_ = robot_W + share * (goal_W - robot_W);
  root_ = point_at(goal_W_);
  const bool room = clearance(map, root_) >= least_clearance_;
  goal_tight_ = !room && try_tight && near_robot(root_);
  if (!room && !goal_tight_) {
    root_ = free_point(map, root_);
    goal_taken_ = share >= 1;
    goal_W_ = position_W(root_);
  }
  ++round_;
  entries_.clear();
  std::ranges::fill(buckets_, 0U);
  bucket_ = 0;
  push(root_, 0, kRoot);
  state_ = State::Searching;
}

Planner::State Planner::search(const LocalMap& map, int budget) {
  if (state_ == State::Searching && corner_W_ != map.corner_W()) state_ = State::Idle;
  if (state_ != State::Searching) return state_;
  while (budget-- > 0) {
    const std::optional<std::uint32_t> next = pop();
    if (!next) return state_ = State::NoWay;
    const std::uint32_t point = *next;
    if (closed_[point] == round_) {
      ++budget;
      continue;
    }
    closed_[point] = round_;
    if (point == robot_) return state_ = State::Found;
    expand(map, point);
  }
  return state_;
}

void Planner::expand(const LocalMap& map, std::uint32_t point) {
  const int column = static_cast<int>(point % kSize);
  const int row = static_cast<int>(point / kSize);
  for (std::size_t m = 0; m < kMoves.size(); ++m) {
    const int x = column + kMoves[m].x;
    const int y = row + kMoves[m].y;
    if (x < 1 || y < 1 || x >= kSize - 1 || y >= kSize - 1) continue;
    const auto next = static_cast<std::uint32_t>(y * kSize + x);
    if (closed_[next] == round_) continue;
    const float cost = cost_of(map, next);
    if (cost < 0) continue;
    const float g = g_[point] + kMoves[m].length * cost;
    if (opened_[next] == round_ && g_[next] <= g) continue;
    push(next, g, static_cast<std::uint8_t>((m + 4) % kMoves.size()));  // back the way it came
  }
}

void Planner::path(Recycled<Vec2>& out) const {
  out.clear();
  if (state_ != State::Found) return;
  out.push_back(robot_W_);
  std::uint32_t point = robot_;
  while (towards_[point] != kRoot) {
    const Move& move = kMoves[towards_[point]];
    point = static_cast<std::uint32_t>(static_cast<int>(point) + move.y * kSize + move.x);
    out.push_back(position_W(point));
  }
  if (out.size() > 1) {
    out.back() = goal_W_;
  } else {
    out.push_back(goal_W_);
  }
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
