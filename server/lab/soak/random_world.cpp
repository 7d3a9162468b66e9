// server/lab/soak/random_world.cpp: shapes, places, and a flood fill.
#include "server/lab/soak/random_world.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "algo/driving.hpp"
#include "sim/obstacle_set.hpp"
#include "sim/random.hpp"

namespace server::soak {
namespace {

constexpr double kHalf = 5.0;    // [m] half of the room's edge
constexpr double kMargin = 3.0;  // [m] around an open room; searched too
constexpr double kCell = 0.05;   // [m]
constexpr double kClear = 0.05;  // [m] clearance of the hull at the start
constexpr double kHull = 0.35;   // [m] hull radius of the Silvermate
constexpr std::uint64_t kPurpose = 0x5041;

/// A convex polygon: points in order on an ellipse.
algo::Polygon polygon(sim::Random& random) {
  const std::size_t corners = 3 + random.below(4);
  const double length = random.uniform(0.15, 0.8);
  const double width = random.uniform(0.15, 0.8);
  algo::Polygon shape;
  for (std::size_t i = 0; i < corners; ++i) {
    const double share =
        (static_cast<double>(i) + random.uniform(0, 0.7)) / static_cast<double>(corners);
    const algo::Vec2 e = algo::direction(2 * std::numbers::pi * share);
    shape.points.emplace_back(length * e.x(), width * e.y());
  }
  return shape;
}

algo::Shape shape(sim::Random& random) {
  switch (random.below(4)) {
    case 0:
      return algo::Cylinder{random.uniform(0.05, 0.6)};
    case 1:
      return algo::Box{random.uniform(0.1, 1.5), random.uniform(0.1, 1.5)};
    case 2:
      return polygon(random);
    default:
      return algo::Wall{random.uniform(0.5, 3.0), 0.05};
  }
}

algo::Pose2 place(sim::Random& random, double half) {
  const double x = random.uniform(-half, half);
  const double y = random.uniform(-half, half);
  return {x, y, algo::wrap_angle(random.uniform(-std::numbers::pi, std::numbers::pi))};
}

void close_room(sim::Scenario& scenario) {
  constexpr double kQuarter = std::numbers::pi / 2;
  for (int side = 0; side < 4; ++side) {
    const algo::Vec2 at_W = kHalf * algo::direction(side * kQuarter);
    algo::Obstacle wall;
    wall.pose_W = {at_W.x(), at_W.y(), algo::wrap_angle((side + 1) * kQuarter)};
    wall.shape = algo::Wall{2 * kHalf + 0.1, 0.1};
    scenario.obstacles.push_back(wall);
  }
}

}  // namespace

sim::Scenario random_world(std::uint64_t seed, const std::string& controller) {
  sim::Random random(seed, kPurpose);
  sim::Scenario scenario;
  scenario.name = "soak-" + std::to_string(seed);
  scenario.title = "Random world " + std::to_string(seed);
  scenario.physics = sim::PhysicsKind::Kinematic;
  scenario.drive.ramps = true;
  scenario.controller = controller;
  if (random.below(3) > 0) close_room(scenario);
  const std::size_t count = 3 + random.below(22);
  for (std::size_t i = 0; i < count; ++i) {
    algo::Obstacle obstacle;
    obstacle.shape = shape(random);
    obstacle.pose_W = place(random, kHalf);
    scenario.obstacles.push_back(obstacle);
  }
  sim::ObstacleSet set;
  std::uint32_t id = 0;
  for (algo::Obstacle& obstacle : scenario.obstacles) {
    obstacle.id = ++id;
    set.add(obstacle);
  }
  do {
    scenario.start = place(random, kHalf - kHull);
  } while (set.distance(scenario.start.position()) < kHull + kClear);
  scenario.goal = algo::SetGoal{place(random, kHalf - 0.2).position(), std::nullopt};
  scenario.parameters = {{&algo::kMaxSpeed, 0.5}};
  return scenario;
}

bool reachable(const sim::Scenario& scenario,
               const algo::Vec2& from_W,
               const algo::Vec2& to_W,
               double radius,
               double reach) {
  sim::ObstacleSet set;
  for (const algo::Obstacle& obstacle : scenario.obstacles) set.add(obstacle);
  const int side = static_cast<int>(std::lround(2 * (kHalf + kMargin) / kCell));
  const auto centre_W = [&](int x, int y) {
    return algo::Vec2(-kHalf - kMargin + (x + 0.5) * kCell, -kHalf - kMargin + (y + 0.5) * kCell);
  };
  const auto cell_of = [](double p) { return algo::whole_below((p + kHalf + kMargin) / kCell); };
  std::vector<std::uint8_t> seen(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  std::vector<std::array<int, 2>> open{{cell_of(from_W.x()), cell_of(from_W.y())}};
  while (!open.empty()) {
    const auto [x, y] = open.back();
    open.pop_back();
    if (x < 0 || y < 0 || x >= side || y >= side) continue;
    std::uint8_t& mark = seen[static_cast<std::size_t>(y) * static_cast<std::size_t>(side) +
                              static_cast<std::size_t>(x)];
    if (mark != 0) continue;
    mark = 1;
    const algo::Vec2 p_W = centre_W(x, y);
    const bool at_start = (p_W - from_W).norm() < 2 * kCell;
    if (!at_start && set.distance(p_W) < radius) continue;
    if ((p_W - to_W).norm() < reach) return true;
    for (const auto& [dx, dy] : {std::array{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      open.push_back({x + dx, y + dy});
    }
  }
  return false;
}

}  // namespace server::soak
