// server/serve/goal_check.cpp: checks the goal itself, then the way there.
#include "server/serve/goal_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "algo/bounds.hpp"
#include "algo/geometry.hpp"
#include "algo/grid_search.hpp"

namespace server {
namespace {

using algo::Vec2;

constexpr double kSlack = 0.01;           // [m] goals are not set more precisely than this
constexpr int kMostCells = 200;           // per side
constexpr double kLeastCell = 0.05;       // [m]
constexpr double kMostLooks = 2'000'000;  // obstacle-cell checks: about 20 ms

/// [m] Free radius that the robot needs at any heading.
double least_room(const algo::RobotSpec& spec) {
  return spec.half_length > 0 ? std::min(spec.half_length, spec.half_width) : spec.radius;
}

/// Grid that blocks a cell if a disc of radius `room` fits at no point of the cell.
class Floor {
 public:
  Floor(const Eigen::AlignedBox2d& world, double room) : room_(room) {
    const double side = world.sizes().maxCoeff() + 4 * room;
    cell_ = std::max(kLeastCell, side / (kMostCells - 1));
    low_ = world.min() - Vec2::Constant(2 * room);
    const Vec2 size = world.sizes() + Vec2::Constant(4 * room);
    grid_.columns = static_cast<int>(size.x() / cell_) + 1;
    grid_.rows = static_cast<int>(size.y() / cell_) + 1;
    costs_.assign(static_cast<std::size_t>(grid_.columns) * static_cast<std::size_t>(grid_.rows),
                  1.0F);
    grid_.costs = costs_;
  }

  algo::GridCell cell_of(const Vec2& p) const {
    const Vec2 at = (p - low_) / cell_;
    return {static_cast<int>(at.x()), static_cast<int>(at.y())};
  }
  /// Blocks cells near `obstacle`. Returns the number of cells checked.
  double block(const algo::Obstacle& obstacle) {
    const double reach = room_ - std::numbers::sqrt2 / 2 * cell_;
    const Eigen::AlignedBox2d box = bounds_W(obstacle);
    const algo::GridCell from = cell_of(box.min() - Vec2::Constant(room_));
    const algo::GridCell to = cell_of(box.max() + Vec2::Constant(room_));
    for (int row = from.row; row <= to.row; ++row) {
      for (int column = from.column; column <= to.column; ++column) {
        const Vec2 middle = low_ + cell_ * Vec2(column + 0.5, row + 0.5);
        if (algo::signed_distance(obstacle, middle) < reach) {
          costs_[grid_.index({column, row})] = algo::CostGrid::kBlocked;
        }
      }
    }
    return static_cast<double>(to.row - from.row + 1) *
           static_cast<double>(to.column - from.column + 1);
  }
  bool connected(const Vec2& a, const Vec2& b) const {
    algo::GridSearch search;
    search.resize(costs_.size());
    return search.find(grid_, cell_of(a), cell_of(b));
  }

 private:
  double room_;
  double cell_ = 0;  // [m]
  Vec2 low_{0, 0};
  std::vector<float> costs_{};
  algo::CostGrid grid_{};
};

/// True if obstacles shut the goal off; false also if the check would take too long.
bool shut_off(double room,
              const Vec2& from,
              const Vec2& to,
              std::span<const algo::Obstacle> obstacles) {
  Eigen::AlignedBox2d world(from);
  world.extend(to);
  for (const algo::Obstacle& obstacle : obstacles) world.extend(bounds_W(obstacle));
  Floor floor(world, room);
  double looks = 0;
  for (const algo::Obstacle& obstacle : obstacles) {
    if (algo::is_ground(obstacle)) continue;
    looks += floor.block(obstacle);
    if (looks > kMostLooks) return false;
  }
  return !floor.connected(from, to);
}

}  // namespace

std::optional<std::string> goal_trouble(const algo::RobotSpec& spec,
                                        const algo::SetGoal& goal,
                                        const algo::Pose2& pose_W,
                                        std::span<const algo::Obstacle> obstacles) {
  const double room = least_room(spec);
  double nearest = std::numeric_limits<double>::infinity();
  for (const algo::Obstacle& obstacle : obstacles) {
    if (algo::is_ground(obstacle)) continue;  // the robot may well stand on it
    nearest = std::min(nearest, algo::signed_distance(obstacle, goal.position_W));
  }
  if (nearest <= 0) return "The goal lies inside an obstacle.";
  if (nearest < room - kSlack) {
    return fmt::format(
        "The robot does not fit there: an obstacle is {:.2f} m from the goal, and it needs {:.2f} "
        "m.",
        nearest,
        room);
  }
  if (!obstacles.empty() && shut_off(room, pose_W.position(), goal.position_W, obstacles)) {
    return "There is no way there: obstacles shut it off for a robot of this width.";
  }
  return std::nullopt;
}

std::optional<std::string> goal_trouble(const algo::RobotSpec& spec,
                                        const algo::SetGoal& goal,
                                        const algo::Pose2& pose_W,
                                        const algo::LaserScan& seen) {
  const double room = least_room(spec);
  const Vec2 eye_W = algo::beam_point_W(pose_W, seen.mount_R, 0, 0);
  const Vec2 to_goal = goal.position_W - eye_W;
  const double bearing = algo::wrap_angle(std::atan2(to_goal.y(), to_goal.x()) - pose_W.heading -
                                          seen.mount_R.heading);
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (seen.status[i] != algo::Beam::Ok) continue;
    const Vec2 point_W = algo::beam_point_W(pose_W, seen.mount_R, seen.angle(i), seen.ranges[i]);
    nearest = std::min(nearest, (point_W - goal.position_W).norm());
  }
  if (nearest < room - kSlack) {
    return fmt::format(
        "The scanner sees something {:.2f} m from the goal, and the robot needs {:.2f} m: it does "
        "not fit there.",
        nearest,
        room);
  }
  const double beam = std::round((bearing - seen.angle_min) / seen.angle_increment);
  if (!(beam >= 0 && beam < static_cast<double>(seen.size()))) {
    return "The scanner does not look that way: nothing is known of the goal.";
  }
  const auto i = static_cast<std::size_t>(beam);
  const double far = to_goal.norm();
  if (far > seen.range_max) {
    return fmt::format(
        "The goal is {:.1f} m away and the scanner sees {:.1f} m: nothing is known of it.",
        far,
        seen.range_max);
  }
  if (seen.status[i] == algo::Beam::Ok && seen.ranges[i] < far - room) {
    return fmt::format(
        "The goal lies behind something that the scanner sees at {:.1f} m: nothing is known of it.",
        seen.ranges[i]);
  }
  return std::nullopt;
}

std::optional<std::string> pose_trouble(const algo::DrawnSpace& map, const algo::Pose2& pose_M) {
  constexpr double kAbout = 2;  // [m] of a given pose, within which a robot looks for itself
  const auto cell = [](double metres) {
    return algo::whole_below(metres / algo::DrawnSpace::kCell);
  };
  for (int row = cell(pose_M.y - kAbout); row <= cell(pose_M.y + kAbout); ++row) {
    for (int column = cell(pose_M.x - kAbout); column <= cell(pose_M.x + kAbout); ++column) {
      if (map.clearance(column, row) != algo::DrawnSpace::kUnknown) return std::nullopt;
    }
  }
  return "The map shows nothing within 2 m of this pose: give one on the map.";
}

}  // namespace server
