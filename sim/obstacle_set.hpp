// sim/obstacle_set.hpp: the obstacles of a world and the distance to the nearest of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "algo/hull.hpp"
#include "algo/obstacle.hpp"
#include "algo/types.hpp"

namespace sim {

using algo::Hull;

/// Where a sensor keeps an obstacle that is not there: out of reach of all of them.
inline constexpr algo::Pose2 kAway{1e7, 1e7, 0};

/// The pose at `now` [s, run clock] of `mover`, which follows a path; kAway while it is away.
algo::Pose2 pose_at(const algo::Obstacle& mover, double now);

/// Obstacles in the order of addition, each with its outline and bounding circle. A distance costs
/// little even with a thousand of them, and allocates nothing. Distances to all of them leave out
/// ramps and trenches, which a robot drives over, and what hangs above the robot; those to one of
/// them do not.
class ObstacleSet {
 public:
  /// For a robot of `tall` [m].
  explicit ObstacleSet(double tall = std::numeric_limits<double>::infinity()) : tall_(tall) {}

  std::size_t size() const { return items_.size(); }
  const algo::Obstacle& operator[](std::size_t index) const { return items_[index].obstacle; }
  /// Index of obstacle `id`.
  std::optional<std::size_t> find(std::uint32_t id) const;

  void add(const algo::Obstacle& obstacle);
  void move(std::size_t index, const algo::Pose2& pose_W);
  void remove(std::size_t index);
  /// Distances ignore obstacle `index` until it is moved again.
  void hide(std::size_t index) { items_[index].hidden = true; }
  void clear() { *this = ObstacleSet(tall_); }

  /// True if a ramp or a trench is among them: the ground is not level.
  bool has_ground() const { return grounds_ > 0; }
  /// [m] Height of the ground at `p_W`: the top of the highest ramp there, else a trench's bottom,
  /// else 0.
  double ground_at(const algo::Vec2& p_W) const;

  /// [m] Distance from `p_W` to the nearest surface: negative inside, infinite without obstacles.
  /// Equals the smallest algo::signed_distance().
  double distance(const algo::Vec2& p_W) const;
  /// The same for obstacle `index` alone.
  double distance(std::size_t index, const algo::Vec2& p_W) const;
  /// [m] Distance from the outline of `hull` at `pose_W` to the nearest surface, infinite without
  /// obstacles. Negative if they overlap: for a disc the depth, for a rectangle any negative
  /// number.
  double clearance(const Hull& hull, const algo::Pose2& pose_W) const;
  /// The same for obstacle `index` alone.
  double clearance(std::size_t index, const Hull& hull, const algo::Pose2& pose_W) const;
  /// True if the bounding circle of obstacle `index` comes within `reach` [m] of `p_W`.
  bool may_reach(std::size_t index, const algo::Vec2& p_W, double reach) const;

 private:
  struct Item {
    algo::Obstacle obstacle{};
    algo::Vec2 centre_W{0, 0};
    double bound = 0;                     // [m] radius of the bounding circle
    std::vector<algo::Vec2> outline_W{};  // empty for a cylinder
    bool hidden = false;
    bool ground = false;
    bool passed = false;  // the robot drives over it or under it
  };
  static void measure(Item& item);
  double clearance(const Item& item, const Hull& hull, const algo::Pose2& pose_W) const;

  double tall_;
  std::vector<Item> items_{};
  std::size_t grounds_ = 0;  // of them, ramps and trenches
};

}  // namespace sim
