// algo/mapping/place_search.hpp: finds all places of a map at which a scan could have been taken.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "algo/mapping/loop_search.hpp"
#include "algo/mapping/wall_pyramid.hpp"
#include "algo/types.hpp"

namespace algo {

/// A pose of R in the map's frame M, and the share of the scan's points on walls there.
using Place = FoundPose;

/// Best-first branch and bound over the whole map and all headings, or over a window. It works in
/// slices, so that a robot may search within its ticks, and allocates at construction only.
class PlaceSearch {
 public:
  static constexpr std::size_t kMostPlaces = 24;
  static constexpr std::size_t kMostPoints = 120;

  explicit PlaceSearch(const Submap& map);

  /// Begins to look for the points of R, of which it takes kMostPoints at even distances.
  void begin(std::span<const Vec2> points_R, const Pose2& guess_M, const SearchWindow& window);
  void begin_everywhere(std::span<const Vec2> points_R);

  /// Looks up at most about `looks` points. True once the search is over.
  bool advance(std::size_t looks);
  bool over() const { return over_; }

  /// Places found, the best first: those that score about as well as the best one.
  std::span<const Place> found() const { return found_; }
  /// More places looked alike than the search can hold.
  bool too_many() const { return too_many_; }

 private:
  /// A square of 2^height cells of poses with one heading.
  struct Branch {
    float score = 0;
    std::int16_t turn = 0, x = 0, y = 0;  // [cells] from the window's corner
    std::uint8_t height = 0;
  };
  static bool worse(const Branch& a, const Branch& b);

  void turn_points(int turn);
  void enter_turn(int turn);
  void push(Branch branch);
  void open(const Branch& branch);
  void settle(const Branch& branch);
  float score(const Branch& branch);
  float least() const;
  Pose2 pose(const Branch& branch) const;

  WallPyramid walls_;
  std::size_t most_turns_ = 0;
  std::vector<std::int16_t> columns_{}, rows_{};  // of each turn's points, at the window's corner
  std::vector<Vec2> points_R_{};
  std::vector<Branch> heap_{};
  std::vector<Place> found_{};
  Vec2 corner_M_{0, 0};  // of the window
  double heading_ = 0;   // [rad] of turn 0
  int turns_ = 0, entered_ = 0;
  int width_ = 0, depth_ = 0;  // [cells] of the window
  std::size_t looked_ = 0;     // points, in this slice
  bool over_ = true;
  bool too_many_ = false;
};

}  // namespace algo
