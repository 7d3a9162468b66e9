// server/lab/buildings/tour_goals.cpp: pens, and places for goals.
#include "server/lab/buildings/tour_goals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <variant>

namespace server::buildings {
namespace {

using algo::Vec2;

constexpr double kRoomAtTourGoal = 0.45;  // [m] from a goal to a surface
constexpr std::size_t kGoalTries = 300;   // places tried
constexpr double kNearest = 1.5;          // [m] from the robot to a goal, at least
constexpr double kNearGoal = 8.0;         // [m] a near goal is within it
constexpr int kFarOf = 5;                 // a far goal is the farthest of so many
constexpr std::size_t kMostPens = 2;
constexpr double kPenHalf = 0.7;      // [m]
constexpr double kAroundPen = 0.5;    // [m] that stay free, for the robot to pass
constexpr double kBeyondWalls = 0.6;  // [m] from the outermost walls to a goal outside
constexpr std::uint64_t kPenPurpose = 0x9E11;
constexpr std::uint64_t kTourPurpose = 0x704A;

struct Corners {
  Vec2 low_W{0, 0};
  Vec2 high_W{0, 0};
};
/// The rectangle of all walls.
Corners corners_of(const std::vector<algo::Obstacle>& obstacles) {
  Corners all{Vec2(1e9, 1e9), Vec2(-1e9, -1e9)};
  for (const algo::Obstacle& obstacle : obstacles) {
    if (!std::holds_alternative<algo::Wall>(obstacle.shape)) continue;
    for (const Vec2& corner : outline_W(obstacle)) {
      all.low_W = all.low_W.cwiseMin(corner);
      all.high_W = all.high_W.cwiseMax(corner);
    }
  }
  return all;
}

Vec2 within(const Vec2& low, const Vec2& high, sim::Random& random) {
  const double u = random.uniform();
  const double v = random.uniform();
  return low + (high - low).cwiseProduct(Vec2(u, v));
}

void add_pen(const Vec2& middle_W, std::vector<algo::Obstacle>& obstacles) {
  for (int side = 0; side < 4; ++side) {
    const double turn = side * std::numbers::pi / 2;
    const Vec2 at_W = middle_W + kPenHalf * algo::direction(turn);
    algo::Obstacle wall;
    wall.id = static_cast<std::uint32_t>(obstacles.size() + 1);
    wall.pose_W = {at_W.x(), at_W.y(), algo::wrap_angle(turn + std::numbers::pi / 2)};
    wall.shape = algo::Wall{2 * kPenHalf + kWall, kWall};
    obstacles.push_back(wall);
  }
}

/// True if a pen leaves a way around it.
bool has_room(const Vec2& middle_W,
              const Vec2& start_W,
              const std::vector<algo::Obstacle>& obstacles) {
  const double reach = kPenHalf * std::numbers::sqrt2 + kWall + 2 * kAroundPen;
  if ((middle_W - start_W).norm() < reach) return false;
  return std::ranges::all_of(obstacles, [&](const algo::Obstacle& obstacle) {
    return signed_distance(obstacle, middle_W) > reach;
  });
}

}  // namespace

TourBuilding tour_building_of(std::uint64_t seed, const std::string& controller) {
  TourBuilding tour{.building = building_of(seed, controller)};
  sim::Scenario& scenario = tour.building.scenario;
  if (tour.building.goal_place == GoalPlace::ShutIn) {
    tour.shut_W.push_back(scenario.goal->position_W);
  }
  std::vector<algo::Obstacle>& obstacles = scenario.obstacles;
  std::erase_if(obstacles, [](const algo::Obstacle& each) { return each.path.has_value(); });
  tour.building.timed_door.reset();
  scenario.goal.reset();
  sim::Random random(seed, kPenPurpose);
  const Corners corners = corners_of(obstacles);
  for (std::size_t pens = 0, k = 0; k < kGoalTries && pens < kMostPens; ++k) {
    const Vec2 middle_W = within(corners.low_W, corners.high_W, random);
    if (!has_room(middle_W, scenario.start.position(), obstacles)) continue;
    add_pen(middle_W, obstacles);
    tour.shut_W.push_back(middle_W);
    ++pens;
  }
  return tour;
}

TourGoals::TourGoals(const TourBuilding& tour, std::uint64_t seed)
    : oracle_(tour.building.scenario.obstacles),
      door_width_(tour.building.door_width),
      obstacles_(tour.building.scenario.obstacles),
      shut_W_(tour.shut_W),
      random_(seed, kTourPurpose) {
  const Corners corners = corners_of(obstacles_);
  low_W_ = corners.low_W;
  high_W_ = corners.high_W;
}

TourGoal TourGoals::next(const Vec2& robot_W) {
  const double share = random_.uniform();
  TourGoal goal;
  if (share < 0.35) {
    goal = {.place = GoalPlace::Near, .position_W = near(robot_W)};
  } else if (share < 0.80) {
    goal = {.place = GoalPlace::Far, .position_W = far(robot_W)};
  } else if (share < 0.90) {
    goal = {.place = GoalPlace::ShutIn, .position_W = shut_in()};
  } else {
    goal = {.place = GoalPlace::Inside, .position_W = inside()};
  }
  goal.truth = between(robot_W, goal.position_W);
  return goal;
}

/// A free place in the building; the freest one tried if narrow corridors have none with as much
/// room.
Vec2 TourGoals::anywhere() {
  Vec2 best_W = within(low_W_, high_W_, random_);
  for (std::size_t k = 0; k < kGoalTries && oracle_.distance(best_W) < kRoomAtTourGoal; ++k) {
    const Vec2 p_W = within(low_W_, high_W_, random_);
    if (oracle_.distance(p_W) > oracle_.distance(best_W)) best_W = p_W;
  }
  return best_W;
}

/// The first place tried within kNearGoal; the nearest one if there is none. Not where the robot
/// stands.
Vec2 TourGoals::near(const Vec2& robot_W) {
  Vec2 best_W = anywhere();
  const auto away = [&](const Vec2& p_W) {
    const double way = (p_W - robot_W).norm();
    return way > kNearest ? way : std::numeric_limits<double>::infinity();
  };
  for (std::size_t k = 0; k < kGoalTries && !(away(best_W) < kNearGoal); ++k) {
    const Vec2 p_W = anywhere();
    if (away(p_W) < away(best_W)) best_W = p_W;
  }
  return best_W;
}

Vec2 TourGoals::far(const Vec2& robot_W) {
  Vec2 best_W = anywhere();
  for (int k = 1; k < kFarOf; ++k) {
    const Vec2 p_W = anywhere();
    if ((p_W - robot_W).norm() > (best_W - robot_W).norm()) best_W = p_W;
  }
  return best_W;
}

/// In a pen or a shut cell, or outside: there the oracle's grid ends after a metre.
Vec2 TourGoals::shut_in() {
  const bool outside = random_.uniform() < 0.5 || shut_W_.empty();
  const std::size_t which = random_.below(outside ? 2 : shut_W_.size());
  if (!outside) return shut_W_[which];
  const Vec2 middle_W = (low_W_ + high_W_) / 2;
  return which == 0 ? Vec2(low_W_.x() - kBeyondWalls, middle_W.y())
                    : Vec2(middle_W.x(), high_W_.y() + kBeyondWalls);
}

/// A point of a thing.
Vec2 TourGoals::inside() {
  const algo::Obstacle& thing = obstacles_[random_.below(obstacles_.size())];
  Vec2 half(0, 0);
  if (const auto* const box = std::get_if<algo::Box>(&thing.shape)) {
    half = Vec2(box->length, box->width) / 2;
  } else if (const auto* const wall = std::get_if<algo::Wall>(&thing.shape)) {
    half = Vec2(wall->length, 0) / 2;
  }
  const Vec2 at = within(-half, half, random_);
  return to_parent(thing.pose_W, at);
}

}  // namespace server::buildings
