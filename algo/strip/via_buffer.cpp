// algo/strip/via_buffer.cpp: Buffer, SortPosition and IsSort, equations.md D.
#include "algo/strip/via_buffer.hpp"

#include <stdexcept>
#include <string>

namespace algo {
namespace {

// 500 mm less a nanometre: an offset is a difference of metres and may fall short by rounding.
constexpr double kSpacing = 0.5 - 1e-9;  // [m]

}  // namespace

bool is_sort(const Vec2& point_W, const Vec2& reference_W, IsSortRule rule) {
  const Vec2 offset = (point_W - reference_W).cwiseAbs();
  if (!offset.allFinite()) return false;
  const bool near_x = offset.x() < kSpacing;
  const bool near_y = offset.y() < kSpacing;
  return rule == IsSortRule::Literal ? !(near_x || near_y) : !(near_x && near_y);
}

void ViaBuffer::clear() {
  points_.clear();
  points_.reserve(kCapacity);
  cursor_ = 0;
}

void ViaBuffer::reset(const Vec2& start_W, const Vec2& goal_W) {
  clear();
  points_.push_back({start_W, false});
  points_.push_back({goal_W, true});
}

void ViaBuffer::assign(const std::vector<Via>& points, std::size_t cursor) {
  if (points.size() > kCapacity) {
    throw std::invalid_argument("the via buffer holds " + std::to_string(kCapacity) +
                                " points, not " + std::to_string(points.size()));
  }
  if (cursor >= points.size() && cursor != 0) {
    throw std::invalid_argument("the via buffer has no point " + std::to_string(cursor));
  }
  clear();
  points_.assign(points.begin(), points.end());
  cursor_ = cursor;
}

std::optional<Via> ViaBuffer::get_position(std::size_t index) const {
  if (index >= points_.size()) return std::nullopt;
  return points_[index];
}

bool ViaBuffer::insert(const Vec2& pass_W, IsSortRule rule) {
  if (cursor_ + 1 >= points_.size()) return false;
  return sort_position(pass_W, Vec2(points_.back().position_W), rule);
}

bool ViaBuffer::sort_position(const Vec2& pass_W, const Vec2& goal_W, IsSortRule rule) {
  if (points_.empty() || cursor_ + 3 > kCapacity) return false;
  if (!is_sort(pass_W, points_[cursor_].position_W, rule)) return false;
  points_.resize(cursor_ + 1);
  points_.push_back({pass_W, false});
  points_.push_back({goal_W, true});
  return true;
}

bool ViaBuffer::advance(const Vec2& position_W, double via_reach, double goal_reach) {
  const std::size_t before = cursor_;
  while (cursor_ + 1 < points_.size()) {
    const Via& next = points_[cursor_ + 1];
    const double reach = next.is_goal ? goal_reach : via_reach;
    if (!((next.position_W - position_W).norm() < reach)) break;
    ++cursor_;
  }
  return cursor_ != before;
}

}  // namespace algo
