// algo/strip/via_buffer.hpp: the list of via points of the sibling thesis (Fig. 25-27), by which
// its sequencing layer drives.
//
// For comparison: while a via is refused the robot drives to the stale one and into things
// (equations.md D). The controllers drive to the direct pass point unless kViaBuffer is set.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "algo/types.hpp"

namespace algo {

enum class IsSortRule : std::uint8_t {
  Corrected,  // both |dx| and |dy| below 500 mm: too near
  Literal,    // either one: refuses a via 2 m straight ahead
};

/// True if a new via at `point_W` is far enough from `reference_W` to be inserted.
/// Source: sibling thesis, IsSort, which prints "or".
bool is_sort(const Vec2& point_W, const Vec2& reference_W, IsSortRule rule);

struct Via {
  Vec2 position_W{0, 0};
  bool is_goal = false;  // the thesis' flag 1; 0 is a via the strip has inserted
  bool operator==(const Via&) const = default;
};

/// Points buf[0..last) and the cursor cur: the point last reached. The robot is on its way to
/// buf[cur + 1]. (Reading cur as the point driven to would put a via behind the goal.)
class ViaBuffer {
 public:
  static constexpr std::size_t kCapacity = 64;

  /// buf[0] = start, buf[1] = goal, cur = 0.
  void reset(const Vec2& start_W, const Vec2& goal_W);
  void clear();

  /// Sets any list of points. Throws std::invalid_argument if there are more than kCapacity, or if
  /// `cursor` is not one of them (0 for an empty list).
  void assign(const std::vector<Via>& points, std::size_t cursor);

  std::size_t cursor() const { return cursor_; }
  std::size_t last() const { return points_.size(); }

  /// Point `index`, or nothing if there is none. The source also reads the point (0, 0) as "none";
  /// a goal at the origin is legal here.
  std::optional<Via> get_position(std::size_t index) const;

  /// One obstacle check: inserts `pass_W` after the point last reached, followed by the present
  /// goal. Returns false and changes nothing if no point is left to drive to, if IsSort refuses, or
  /// if the buffer is full.
  bool insert(const Vec2& pass_W, IsSortRule rule = IsSortRule::Corrected);

  /// SortPosition: if IsSort accepts `pass_W` against buf[cur], drops buf[cur+1..last) and appends
  /// the pass point (flag 0) and `goal_W` (flag 1): three live points, the "3 buffers".
  bool sort_position(const Vec2& pass_W,
                     const Vec2& goal_W,
                     IsSortRule rule = IsSortRule::Corrected);

  /// Moves the cursor past every via within `via_reach` and the goal within `goal_reach` [m] of
  /// `position_W`; true if it moved.
  bool advance(const Vec2& position_W, double via_reach = 0.6, double goal_reach = 0.1);

 private:
  std::vector<Via> points_{};
  std::size_t cursor_ = 0;
};

}  // namespace algo
