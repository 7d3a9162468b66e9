// server/lab/soak/indoor_world.cpp: walls, furniture and people.
#include "server/lab/soak/indoor_world.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>

#include "sim/obstacle_set.hpp"
#include "sim/random.hpp"

namespace server::soak {
namespace {

using algo::Vec2;

constexpr double kHalfLength = 6.0, kHalfWidth = 4.5;  // [m] of the floor
constexpr double kIndoorWall = 0.1;                    // [m] of a wall
constexpr double kHallGap = 2.2;                       // [m] between a hall's columns
constexpr double kWalkRoom = 0.35;   // [m] between a person's way and all that stands
constexpr double kStartRoom = 0.3;   // [m] around the robot's circle at the start,
constexpr double kPersonAway = 1.5;  // [m] and between it and a person's way
constexpr double kPauses = 1.0;      // [s] at either end of a way
constexpr int kTries = 400;          // places tried for one thing
constexpr std::uint64_t kIndoorPurpose = 0x1D00;

/// Adds obstacles to a scenario, and knows the room between them.
class Builder {
 public:
  Builder(sim::Scenario& scenario, std::uint64_t seed)
      : scenario_(scenario), random_(seed, kIndoorPurpose) {}

  sim::Random& random() { return random_; }

  void add(const algo::Pose2& pose_W, const algo::Shape& shape) {
    algo::Obstacle obstacle;
    obstacle.id = static_cast<std::uint32_t>(scenario_.obstacles.size() + 1);
    obstacle.pose_W = pose_W;
    obstacle.shape = shape;
    scenario_.obstacles.push_back(obstacle);
    set_.add(obstacle);
  }
  void wall(const Vec2& from_W, const Vec2& to_W) {
    const Vec2 way = to_W - from_W;
    if (way.norm() < kIndoorWall) return;
    const Vec2 middle_W = (from_W + to_W) / 2;
    add({middle_W.x(), middle_W.y(), std::atan2(way.y(), way.x())},
        algo::Wall{way.norm() + kIndoorWall, kIndoorWall});
  }
  /// A wall with a door of 0.9 to 1.2 m somewhere.
  void wall_with_door(const Vec2& from_W, const Vec2& to_W) {
    const double length = (to_W - from_W).norm();
    const Vec2 along = (to_W - from_W) / length;
    const double door =
        random_.uniform(0.9, 1.2) + kIndoorWall;  // walls end half a thickness later
    const double at = random_.uniform(0.5, length - 0.5 - door);
    wall(from_W, from_W + at * along);
    wall(from_W + (at + door) * along, to_W);
  }

  Vec2 anywhere(double margin) {
    const double x = random_.uniform(-kHalfLength + margin, kHalfLength - margin);
    return {x, random_.uniform(-kHalfWidth + margin, kHalfWidth - margin)};
  }
  double room(const Vec2& p_W) const { return set_.distance(p_W); }
  /// A place with `room` [m] to all obstacles; nothing after kTries tries.
  std::optional<Vec2> place(double wanted_room) {
    for (int k = 0; k < kTries; ++k) {
      const Vec2 p_W = anywhere(wanted_room);
      if (room(p_W) >= wanted_room) return p_W;
    }
    return std::nullopt;
  }
  /// True if the straight way keeps `wanted_room` [m].
  bool sees(const Vec2& from_W, const Vec2& to_W, double wanted_room) const {
    const int steps = 1 + static_cast<int>((to_W - from_W).norm() / 0.1);
    for (int k = 0; k <= steps; ++k) {
      if (room(from_W + k * (to_W - from_W) / steps) < wanted_room) return false;
    }
    return true;
  }

  void thing(double least, double most, double wanted_room) {
    const double size = random_.uniform(least, most);
    const double other = random_.uniform(least, most);
    const double heading = random_.uniform(-std::numbers::pi, std::numbers::pi);
    const std::size_t kind = random_.below(3);
    const auto at_W = place(std::hypot(size, other) / 2 + wanted_room);
    if (!at_W) return;
    const algo::Pose2 pose_W{at_W->x(), at_W->y(), heading};
    if (kind == 0) {
      add(pose_W, algo::Cylinder{size / 2});
    } else if (kind == 1) {
      add(pose_W, algo::Box{size, other});
    } else {
      add(pose_W, algo::Wall{size, 0.05});
    }
  }

  void person(const Vec2& start_W) {
    const double radius = random_.uniform(0.2, 0.28);
    const double speed = random_.uniform(0.5, 1.3);
    const double phase = random_.uniform();
    const double wanted = radius + kWalkRoom;
    for (int k = 0; k < kTries; ++k) {
      const Vec2 from_W = anywhere(wanted);
      const Vec2 to_W = anywhere(wanted);
      const double length = (to_W - from_W).norm();
      if (length < 2 || !sees(from_W, to_W, wanted)) continue;
      const double across = std::sqrt(algo::squared_distance(start_W, from_W, to_W));
      if (across < kPersonAway) continue;
      algo::Obstacle obstacle;
      obstacle.id = static_cast<std::uint32_t>(scenario_.obstacles.size() + 1);
      obstacle.shape = algo::Cylinder{radius};
      obstacle.height = 1.7;
      const double walk = length / speed;
      algo::ObstaclePath path;
      path.period = 2 * (walk + kPauses);
      path.phase = phase * path.period;
      path.keys = {{0, from_W},
                   {walk, to_W},
                   {walk + kPauses, to_W},
                   {2 * walk + kPauses, from_W},
                   {path.period, from_W}};
      const Vec2 at_W = path.at(0);
      obstacle.pose_W = {at_W.x(), at_W.y(), 0};
      obstacle.path = path;
      scenario_.obstacles.push_back(obstacle);
      return;
    }
  }

 private:
  sim::Scenario& scenario_;
  sim::Random random_;
  sim::ObstacleSet set_{};  // of all that stands
};

void add_outer_walls(Builder& build) {
  const Vec2 a(-kHalfLength, -kHalfWidth);
  const Vec2 b(kHalfLength, -kHalfWidth);
  const Vec2 c(kHalfLength, kHalfWidth);
  const Vec2 d(-kHalfLength, kHalfWidth);
  build.wall(a, b);
  build.wall(b, c);
  build.wall(c, d);
  build.wall(d, a);
}

/// Blocks with 1.2 to 1.8 m between them.
void add_corridors(Builder& build) {
  const double width = build.random().uniform(1.2, 1.8);
  constexpr int kColumns = 3;
  constexpr int kRows = 2;
  const double length = (2 * kHalfLength - (kColumns + 1) * width) / kColumns;
  const double depth = (2 * kHalfWidth - (kRows + 1) * width) / kRows;
  for (int i = 0; i < kColumns; ++i) {
    for (int k = 0; k < kRows; ++k) {
      build.add({-kHalfLength + width + length / 2 + i * (length + width),
                 -kHalfWidth + width + depth / 2 + k * (depth + width),
                 0},
                algo::Box{length, depth});
    }
  }
}

void add_rooms(Builder& build) {
  const double x = build.random().uniform(-2, 2);
  const double y = build.random().uniform(-1.2, 1.2);
  build.wall_with_door({x, -kHalfWidth}, {x, y});
  build.wall_with_door({x, y}, {x, kHalfWidth});
  build.wall_with_door({-kHalfLength, y}, {x, y});
  build.wall_with_door({x, y}, {kHalfLength, y});
}

}  // namespace

std::string_view name(Indoors kind) {
  switch (kind) {
    case Indoors::Clutter:
      return "clutter";
    case Indoors::Corridors:
      return "corridors";
    case Indoors::Doors:
      return "doors";
    default:
      return "hall";
  }
}

Indoors indoors_of(std::uint64_t seed) {
  return kIndoors.at(seed % kIndoors.size());
}

sim::Scenario indoor_world(std::uint64_t seed, double radius) {
  const Indoors kind = indoors_of(seed);
  sim::Scenario scenario;
  scenario.name = "indoors-" + std::to_string(seed);
  scenario.title = std::string(name(kind)) + " " + std::to_string(seed);
  scenario.drive.ramps = true;
  Builder build(scenario, seed);
  add_outer_walls(build);
  if (kind == Indoors::Corridors) add_corridors(build);
  if (kind == Indoors::Doors) add_rooms(build);
  const std::size_t things = kind == Indoors::Clutter ? 10 + build.random().below(11)
                             : kind == Indoors::Doors ? 4 + build.random().below(5)
                             : kind == Indoors::Hall  ? 2 + build.random().below(4)
                                                      : 0;
  for (std::size_t k = 0; k < things; ++k) {
    if (kind == Indoors::Hall) {
      build.thing(0.2, 0.6, kHallGap);
    } else {
      build.thing(0.06, 1.0, 0);
    }
  }
  std::optional<Vec2> start_W;
  for (double room = radius + kStartRoom; !start_W; room *= 0.9) start_W = build.place(room);
  scenario.start = {
      start_W->x(), start_W->y(), build.random().uniform(-std::numbers::pi, std::numbers::pi)};
  const std::size_t people = build.random().below(4);
  for (std::size_t k = 0; k < people; ++k) build.person(*start_W);
  return scenario;
}

}  // namespace server::soak
