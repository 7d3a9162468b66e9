// server/experiment/layouts.cpp: draws obstacles one by one, and redraws those that do not fit.
#include "server/experiment/layouts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "algo/driving.hpp"
#include "algo/strip/strip_law.hpp"
#include "sim/random.hpp"

namespace server::experiment {
namespace {

using algo::Vec2;

constexpr std::uint64_t kLayoutsPurpose = 0x6c61796f75747300;  // "layouts": the generator's purpose
constexpr int kTries = 200;     // for one obstacle before the layout starts again
constexpr int kDraws = 50'000;  // of all obstacles of a layout before its rules are given up
const Vec2 kGoal{5.0, 4.0};     // [m] of case 3; the start is the origin

/// A cylinder or a box with equal probability, at any heading, its centre anywhere along and beside
/// the line.
algo::Obstacle draw(sim::Random& random, std::uint32_t id, double farthest) {
  const Vec2 along = kGoal.normalized();
  const Vec2 across{-along.y(), along.x()};
  const double way = random.uniform(0, kGoal.norm());
  const double aside = random.uniform(-farthest, farthest);
  const Vec2 centre = way * along + aside * across;
  algo::Obstacle obstacle;
  obstacle.id = id;
  obstacle.pose_W = {centre.x(), centre.y(), random.uniform(-std::numbers::pi, std::numbers::pi)};
  if (random.uniform() < 0.5) {
    obstacle.shape = algo::Cylinder{random.uniform(0.25, 0.4)};
  } else {
    const double length = random.uniform(0.5, 0.8);
    obstacle.shape = algo::Box{length, random.uniform(0.5, 0.8)};
  }
  return obstacle;
}

/// True if the robot would touch the obstacle on the straight line.
bool in_lane(const algo::Obstacle& obstacle) {
  const Vec2 along = kGoal.normalized();
  const auto aside = [&](const Vec2& p) { return along.x() * p.y() - along.y() * p.x(); };
  double low = aside(obstacle.pose_W.position());
  double high = low;
  if (const auto* cylinder = std::get_if<algo::Cylinder>(&obstacle.shape)) {
    low -= cylinder->radius;
    high += cylinder->radius;
  }
  for (const Vec2& corner : outline_W(obstacle)) {
    low = std::min(low, aside(corner));
    high = std::max(high, aside(corner));
  }
  return low < kLaneHalf && high > -kLaneHalf;
}

bool fits(const algo::Obstacle& obstacle, const std::vector<algo::Obstacle>& others, double gap) {
  if (signed_distance(obstacle, Vec2(0, 0)) < kFreeRoom) return false;
  if (signed_distance(obstacle, kGoal) < kFreeRoom) return false;
  return std::ranges::all_of(
      others, [&](const auto& other) { return surface_gap(obstacle, other) >= gap; });
}

/// Empty if an obstacle found no place. Adds its draws to `draws`.
std::vector<algo::Obstacle> draw_all(sim::Random& random, const LayoutRules& rules, int& draws) {
  std::vector<algo::Obstacle> obstacles;
  for (int tries = 0; obstacles.size() < rules.obstacles && tries < kTries; ++tries) {
    ++draws;
    algo::Obstacle next =
        draw(random, static_cast<std::uint32_t>(obstacles.size() + 1), rules.aside);
    if (!fits(next, obstacles, rules.gap)) continue;
    obstacles.push_back(std::move(next));
    tries = 0;
  }
  if (obstacles.size() < rules.obstacles) obstacles.clear();
  return obstacles;
}

}  // namespace

double surface_gap(const algo::Obstacle& a, const algo::Obstacle& b) {
  const auto* const round_a = std::get_if<algo::Cylinder>(&a.shape);
  const auto* const round_b = std::get_if<algo::Cylinder>(&b.shape);
  if (round_a != nullptr) return signed_distance(b, a.pose_W.position()) - round_a->radius;
  if (round_b != nullptr) return signed_distance(a, b.pose_W.position()) - round_b->radius;
  // Two separate convex outlines are nearest at a vertex of one of them. Crossed boxes may contain
  // no vertex of each other, but they contain each other's centre.
  double nearest =
      std::min(signed_distance(a, b.pose_W.position()), signed_distance(b, a.pose_W.position()));
  for (const Vec2& corner : outline_W(a)) nearest = std::min(nearest, signed_distance(b, corner));
  for (const Vec2& corner : outline_W(b)) nearest = std::min(nearest, signed_distance(a, corner));
  return nearest;
}

double area_of(const LayoutRules& rules) {
  return kGoal.norm() * 2 * rules.aside;
}

sim::Scenario random_layout(const LayoutRules& rules, std::size_t index) {
  sim::Scenario layout;
  layout.name = fmt::format("random-{}-", rules.obstacles);
  if (rules.gap != kFreeGap) layout.name += fmt::format("gap{:.0f}-", 1000 * rules.gap);
  if (rules.aside != kAside) layout.name += fmt::format("aside{:.0f}-", 1000 * rules.aside);
  layout.name += fmt::format("{:04d}", index);
  layout.title = fmt::format("Random layout {} of {} obstacles", index, rules.obstacles);
  layout.start.heading = std::atan2(kGoal.y(), kGoal.x());
  layout.goal = algo::SetGoal{kGoal, std::nullopt};
  layout.parameters = {{&algo::kContractionGain, 0.6},
                       {&algo::kRepulsionGain, rules.repulsion_gain},
                       {&algo::kMaxSpeed, 0.1}};
  sim::Random random(index, kLayoutsPurpose + rules.obstacles);
  for (int draws = 0; draws < kDraws;) {
    layout.obstacles = draw_all(random, rules, draws);
    if (std::ranges::any_of(layout.obstacles, in_lane)) return layout;
  }
  throw std::runtime_error(fmt::format(
      "{} obstacles with free gaps of {:g} m find no place within {:g} m of the straight "
      "line",
      rules.obstacles,
      rules.gap,
      rules.aside));
}

}  // namespace server::experiment
