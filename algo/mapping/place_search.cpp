// algo/mapping/place_search.cpp: the best branch of all is opened next, until the rest is worse.
#include "algo/mapping/place_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace algo {
namespace {

constexpr double kPlaceCell = 0.2;       // [m]; a match finds the rest
constexpr std::size_t kPlaceLevels = 5;  // the coarsest looks at 3.2 m at once
constexpr double kPlaceTurn = 0.025;     // [rad]
constexpr float kLeastPlace = 0.5F;      // score
constexpr float kAlike = 0.75F;          // of the best score: it could be this place too
constexpr double kPlaceApart = 1.0;      // [m] between two places,
constexpr double kPlaceTurnApart = 0.4;  // [rad] or headings
constexpr std::size_t kSpare = 300'000;  // branches beside those of the coarsest level

}  // namespace

PlaceSearch::PlaceSearch(const Submap& map)
    : walls_(map, kPlaceCell, kPlaceLevels),
      most_turns_(static_cast<std::size_t>(std::ceil(2 * std::numbers::pi / kPlaceTurn)) + 1) {
  const std::size_t side = std::size_t{1} << (kPlaceLevels - 1);
  const std::size_t blocks = (static_cast<std::size_t>(walls_.columns()) / side + 1) *
                             (static_cast<std::size_t>(walls_.rows()) / side + 1);
  heap_.reserve(blocks * most_turns_ + kSpare);
  columns_.resize(most_turns_ * kMostPoints);
  rows_.resize(most_turns_ * kMostPoints);
  points_R_.reserve(kMostPoints);
  found_.reserve(kMostPlaces);
}

void PlaceSearch::begin_everywhere(std::span<const Vec2> points_R) {
  const Vec2 half = walls_.cell() / 2 * Vec2(walls_.columns(), walls_.rows());
  const Vec2 middle_M = walls_.corner() + half;
  begin(points_R, {middle_M.x(), middle_M.y(), 0}, {half.x(), half.y(), std::numbers::pi});
}

void PlaceSearch::begin(std::span<const Vec2> points_R,
                        const Pose2& guess_M,
                        const SearchWindow& window) {
  points_R_.clear();
  const std::size_t count = std::min(points_R.size(), kMostPoints);
  for (std::size_t k = 0; k < count; ++k)
    points_R_.push_back(points_R[k * points_R.size() / count]);
  corner_M_ = guess_M.position() - Vec2(window.x, window.y);
  width_ = static_cast<int>(2 * window.x / walls_.cell()) + 1;
  depth_ = static_cast<int>(2 * window.y / walls_.cell()) + 1;
  const int half = static_cast<int>(std::ceil(window.heading / kPlaceTurn));
  turns_ = std::min(2 * half + 1, static_cast<int>(most_turns_));
  heading_ = guess_M.heading - half * kPlaceTurn;
  entered_ = 0;
  heap_.clear();
  found_.clear();
  too_many_ = false;
  over_ = points_R_.empty();
}

bool PlaceSearch::worse(const Branch& a, const Branch& b) {
  return std::tie(a.score, b.height, b.turn, b.y, b.x) <
         std::tie(b.score, a.height, a.turn, a.y, a.x);
}

Pose2 PlaceSearch::pose(const Branch& branch) const {
  return {corner_M_.x() + walls_.cell() * branch.x,
          corner_M_.y() + walls_.cell() * branch.y,
          wrap_angle(heading_ + kPlaceTurn * branch.turn)};
}

void PlaceSearch::turn_points(int turn) {
  const Pose2 at{corner_M_.x(), corner_M_.y(), heading_ + kPlaceTurn * turn};
  const std::size_t first = static_cast<std::size_t>(turn) * kMostPoints;
  for (std::size_t k = 0; k < points_R_.size(); ++k) {
    const Vec2 off = walls_.cells_to(to_parent(at, points_R_[k]));
    columns_[first + k] = static_cast<std::int16_t>(std::floor(off.x()));
    rows_[first + k] = static_cast<std::int16_t>(std::floor(off.y()));
  }
}

/// Upper bound of the share of points on walls, over all poses of the branch.
float PlaceSearch::score(const Branch& branch) {
  const std::size_t first = static_cast<std::size_t>(branch.turn) * kMostPoints;
  unsigned sum = 0;
  for (std::size_t k = first; k < first + points_R_.size(); ++k) {
    sum += walls_.at(branch.height, columns_[k] + branch.x, rows_[k] + branch.y);
  }
  looked_ += points_R_.size();
  return static_cast<float>(sum) / static_cast<float>(WallPyramid::kOnWall * points_R_.size());
}

float PlaceSearch::least() const {
  if (found_.empty()) return kLeastPlace;
  return std::max(kLeastPlace, kAlike * static_cast<float>(found_.front().score));
}

void PlaceSearch::push(Branch branch) {
  branch.score = score(branch);
  if (branch.score < least()) return;
  if (heap_.size() == heap_.capacity()) {
    too_many_ = true;
    over_ = true;
    return;
  }
  heap_.push_back(branch);
  std::ranges::push_heap(heap_, worse);
}

void PlaceSearch::enter_turn(int turn) {
  turn_points(turn);
  constexpr int kSide = 1 << (kPlaceLevels - 1);
  for (int y = 0; y < depth_; y += kSide) {
    for (int x = 0; x < width_; x += kSide) {
      push({.turn = static_cast<std::int16_t>(turn),
            .x = static_cast<std::int16_t>(x),
            .y = static_cast<std::int16_t>(y),
            .height = kPlaceLevels - 1});
    }
  }
}

void PlaceSearch::open(const Branch& branch) {
  const int half = 1 << (branch.height - 1);
  for (const int dy : {0, half}) {
    for (const int dx : {0, half}) {
      Branch child = branch;
      child.x = static_cast<std::int16_t>(branch.x + dx);
      child.y = static_cast<std::int16_t>(branch.y + dy);
      child.height = static_cast<std::uint8_t>(branch.height - 1);
      if (child.x < width_ && child.y < depth_) push(child);
    }
  }
}

/// A single pose, better than all that is left.
void PlaceSearch::settle(const Branch& branch) {
  const Pose2 here_M = pose(branch);
  const bool known = std::ranges::any_of(found_, [&](const Place& place) {
    return (place.pose.position() - here_M.position()).norm() < kPlaceApart &&
           std::abs(wrap_angle(place.pose.heading - here_M.heading)) < kPlaceTurnApart;
  });
  if (known) return;
  if (found_.size() == kMostPlaces) {
    too_many_ = true;
    over_ = true;
    return;
  }
  found_.push_back({here_M, static_cast<double>(branch.score)});
}

bool PlaceSearch::advance(std::size_t looks) {
  looked_ = 0;
  while (!over_ && looked_ < looks) {
    if (entered_ < turns_) {
      enter_turn(entered_++);
      continue;
    }
    if (heap_.empty() || heap_.front().score < least()) {
      over_ = true;
      break;
    }
    std::ranges::pop_heap(heap_, worse);
    const Branch branch = heap_.back();
    heap_.pop_back();
    if (branch.height > 0) {
      open(branch);
    } else {
      settle(branch);
    }
  }
  return over_;
}

}  // namespace algo
