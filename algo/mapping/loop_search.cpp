// algo/mapping/loop_search.cpp: branch and bound over a pyramid of walls.
#include "algo/mapping/loop_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace algo {
namespace {

constexpr double kSearchCell = 0.1;             // [m]
constexpr std::size_t kLevels = 6;              // the coarsest looks at 2^5 cells at once
constexpr double kFarPoint = 12;                // [m] at which a turn step moves a point by a cell
constexpr std::size_t kMostBranches = 400'000;  // opened by one search

}  // namespace

LoopSearch::LoopSearch(const Submap& walls) : walls_(walls, kSearchCell, kLevels) {}

double LoopSearch::score(const Turned& turned, std::size_t height, int x, int y) const {
  unsigned sum = 0;
  for (std::size_t k = 0; k < turned.columns.size(); ++k) {
    sum += walls_.at(height, turned.columns[k] + x, turned.rows[k] + y);
  }
  return sum /
         (static_cast<double>(WallPyramid::kOnWall) * static_cast<double>(turned.columns.size()));
}

/// One search: the turned points, and the branches not yet looked at.
struct LoopSearch::Search {
  const LoopSearch& grid;
  std::span<const FoundPose> known;
  double apart = 0;
  Vec2 corner{0, 0};  // position of the frame of the points at the window's corner
  int columns = 0, rows = 0;
  std::vector<Turned> turns{};
  Branch best{};
  std::size_t opened = 0;

  /// The whole branch lies near a pose that is known.
  bool excluded(const Branch& branch, int side) const {
    const Vec2 middle =
        corner + kSearchCell * Vec2(branch.x + (side - 1) / 2.0, branch.y + (side - 1) / 2.0);
    const double half = kSearchCell * (side - 1) / 2.0 * std::sqrt(2.0);
    return std::ranges::any_of(known, [&](const FoundPose& pose) {
      return (pose.pose.position() - middle).norm() + half < apart;
    });
  }

  void open(const Branch& branch, std::size_t height) {
    if (height == 0) {
      best = branch;
      return;
    }
    const int half = 1 << (height - 1);
    std::array<Branch, 4> next{};
    std::size_t count = 0;
    for (const int dy : {0, half}) {
      for (const int dx : {0, half}) {
        Branch child{branch.turn, branch.x + dx, branch.y + dy, 0};
        if (child.x >= columns || child.y >= rows || excluded(child, half)) continue;
        child.score =
            grid.score(turns[static_cast<std::size_t>(child.turn)], height - 1, child.x, child.y);
        ++opened;
        next[count++] = child;
      }
    }
    const auto children = std::span(next).first(count);
    std::ranges::stable_sort(children, std::greater{}, &Branch::score);
    for (const Branch& child : children) {
      if (opened > kMostBranches) return;
      if (child.score > best.score) open(child, height - 1);
    }
  }
};

std::optional<FoundPose> LoopSearch::best(std::span<const Vec2> points,
                                          const Pose2& guess,
                                          const SearchWindow& window,
                                          double least_score,
                                          std::span<const FoundPose> known,
                                          double apart) const {
  if (points.empty()) return std::nullopt;
  Search search{.grid = *this, .known = known, .apart = apart};
  search.corner = guess.position() - Vec2(window.x, window.y);
  search.columns = static_cast<int>(2 * window.x / kSearchCell) + 1;
  search.rows = static_cast<int>(2 * window.y / kSearchCell) + 1;
  search.best.score = least_score;
  search.best.turn = -1;
  const double turn_step = kSearchCell / kFarPoint;
  const int turns = static_cast<int>(std::ceil(window.heading / turn_step));
  for (int a = -turns; a <= turns; ++a) {
    Turned& turned = search.turns.emplace_back();
    turned.heading = guess.heading + a * turn_step;
    const Pose2 at{search.corner.x(), search.corner.y(), turned.heading};
    for (const Vec2& point : points) {
      const Vec2 off = walls_.cells_to(to_parent(at, point));
      turned.columns.push_back(whole_below(off.x()));
      turned.rows.push_back(whole_below(off.y()));
    }
  }
  constexpr std::size_t kTop = kLevels - 1;
  constexpr int kTopSide = 1 << kTop;
  std::vector<Branch> branches;
  for (int a = 0; a <= 2 * turns; ++a) {
    for (int y = 0; y < search.rows; y += kTopSide) {
      for (int x = 0; x < search.columns; x += kTopSide) {
        const Branch branch{a, x, y, score(search.turns[static_cast<std::size_t>(a)], kTop, x, y)};
        if (branch.score > least_score) branches.push_back(branch);
      }
    }
  }
  std::ranges::sort(branches, std::greater{}, [](const Branch& b) {
    return std::tuple(b.score, b.turn, b.y, b.x);
  });
  for (const Branch& branch : branches) {
    if (branch.score <= search.best.score) break;
    search.open(branch, kTop);
    if (search.opened > kMostBranches) return std::nullopt;
  }
  if (search.best.turn < 0) return std::nullopt;
  const Turned& turned = search.turns[static_cast<std::size_t>(search.best.turn)];
  return FoundPose{{search.corner.x() + kSearchCell * search.best.x,
                    search.corner.y() + kSearchCell * search.best.y,
                    wrap_angle(turned.heading)},
                   search.best.score};
}

}  // namespace algo
