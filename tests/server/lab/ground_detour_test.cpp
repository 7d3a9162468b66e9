// tests/server/lab/ground_detour_test.cpp: a robot with floor sensors goes round ground that it
// must not cross.
#include <algorithm>

#include <gtest/gtest.h>

#include "algo/pipeline/pipeline.hpp"
#include "server/run/robot_library.hpp"
#include "sim/world.hpp"

namespace server {
namespace {

constexpr double kDetourTime = 120;  // [s] at most
constexpr double kPieceWidth = 0.8;  // [m] across the way

/// Drives `masuda` 4 m ahead by `strip`, with `piece` 1.5 m ahead.
struct Detour {
  bool arrived = false;
  double aside = 0;  // [m] at most
  explicit Detour(const algo::Obstacle& piece) {
    sim::Scenario scenario;
    scenario.robot = builtin_robot("masuda");
    scenario.physics = sim::PhysicsKind::Bullet;
    scenario.obstacles.push_back(piece);
    sim::World world(scenario, 1);
    algo::Pipeline pipeline({.controller = "strip", .by_hand = false}, world.spec());
    algo::Telemetry t;
    world.reset(t.observation);
    pipeline.reset(t.observation.odometry.pose);
    t.requests.push_back(algo::SetGoal{{4, 0}, std::nullopt});
    const auto ticks = static_cast<int>(kDetourTime / world.spec().period);
    for (int k = 0; k < ticks && !arrived; ++k) {
      pipeline.tick(t);
      t.requests.clear();
      arrived = t.mission == algo::Mission::Arrived;
      world.step(t.command, t.observation);
      aside = std::max(aside, std::abs(world.pose_W().y));
      if (world.overturned() || t.mission == algo::Mission::Stuck) break;
    }
    arrived = arrived && (world.pose_W().position() - algo::Vec2(4, 0)).norm() < 0.2;
  }
};

TEST(GroundDetour, StripGoesRoundATrenchThatIsTooWide) {
  const Detour detour(
      {.id = 1, .pose_W = {1.5, 0, 0}, .shape = algo::Trench{0.06, kPieceWidth, 0.05}});
  EXPECT_TRUE(detour.arrived);
  EXPECT_GT(detour.aside, kPieceWidth / 2);
}

TEST(GroundDetour, StripGoesRoundAStepThatIsTooHigh) {
  algo::Obstacle step{.id = 1, .pose_W = {1.8, 0, 0}, .shape = algo::Ramp{0.5, kPieceWidth, 0.02}};
  step.height = 0.02;
  const Detour detour(step);
  EXPECT_TRUE(detour.arrived);
  EXPECT_GT(detour.aside, kPieceWidth / 2);
}

}  // namespace
}  // namespace server
