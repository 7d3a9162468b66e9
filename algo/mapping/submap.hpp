// algo/mapping/submap.hpp: a finished piece of map, small enough to keep thousands of them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "algo/mapping/facing.hpp"
#include "algo/mapping/occupancy_map.hpp"
#include "algo/types.hpp"

namespace algo {

/// The place of a cell among rows of `columns` cells. None of the arguments is negative.
inline std::size_t cell_index(int column, int row, int columns) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
         static_cast<std::size_t>(column);
}

/// The walls and the free space seen along some metres of way, in the frame of its first pose.
class Submap {
 public:
  explicit Submap(const OccupancyMap& map);

  /// As OccupancyMap::each_near(): what a ScanMatcher asks for.
  template <typename See>
  void each_near(const Vec2& p, double reach, See&& see) const {
    each_place_near(p, reach, [&](std::size_t k) { see(walls_[k].template cast<double>()); });
  }
  /// Likewise, for the walls that may be of one surface with `facing`.
  template <typename See>
  void each_facing(const Vec2& p, const Facing& facing, double reach, See&& see) const {
    each_place_near(p, reach, [&](std::size_t k) {
      if (may_be_one(facing_of(k), facing)) see(walls_[k].template cast<double>());
    });
  }
  bool wall_within(const Vec2& p, double reach) const;
  bool wall_within(const Vec2& p, const Facing& facing, double reach) const;
  /// Beams went through here, and nothing stood near.
  bool is_free(const Vec2& p) const;

  std::span<const Eigen::Vector2f> walls() const { return walls_; }
  /// Walls thinned to `spacing` [m], about evenly.
  FacedPoints thinned(double spacing) const;
  Vec2 centre() const { return centre_; }
  std::size_t bytes() const;

 private:
  static constexpr double kBin = 0.5;  // [m] edge of a square of the index
  static constexpr int kBlock = 4;     // cells along the edge of a block of free space

  /// A wall's Facing in three bytes.
  struct Side {
    std::int8_t x = 0, y = 0;  // in 1 / kUnit
    bool normal = false;
    static constexpr int kUnit = 100;
  };

  Facing facing_of(std::size_t k) const {
    const Side& side = sides_[k];
    return {Vec2(side.x, side.y) / Side::kUnit, side.normal};
  }
  template <typename See>
  void each_place_near(const Vec2& p, double reach, See&& see) const {
    const int left = column(p.x() - reach);
    const int right = column(p.x() + reach);
    const int top = row(p.y() + reach);
    for (int j = row(p.y() - reach); j <= top; ++j) {
      const std::size_t first = first_[at(left, j)];
      const std::size_t last = first_[at(right, j) + 1];
      for (std::size_t k = first; k < last; ++k) {
        const Vec2 point = walls_[k].cast<double>();
        if (std::abs(point.x() - p.x()) <= reach && std::abs(point.y() - p.y()) <= reach) see(k);
      }
    }
  }
  int column(double x) const { return std::clamp(bin(x - corner_.x()), 0, columns_ - 1); }
  int row(double y) const { return std::clamp(bin(y - corner_.y()), 0, rows_ - 1); }
  static int bin(double way) { return whole_below(way / kBin); }
  std::size_t at(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  void keep_walls(const OccupancyMap& map);
  void find_normals();
  void keep_free(const OccupancyMap& map);

  std::vector<Eigen::Vector2f> walls_{};  // by rows and columns of the index
  std::vector<Side> sides_{};             // of each wall
  std::vector<std::uint32_t> first_{};    // place of each square's first wall; one more at the end
  int columns_ = 1, rows_ = 1;
  Vec2 corner_{0, 0};
  Vec2 centre_{0, 0};  // mean of the walls
  std::vector<bool> free_{};
  OccupancyMap::Index low_{};  // first block
  int free_columns_ = 0, free_rows_ = 0;
  double block_ = 0;  // [m]
};

}  // namespace algo
