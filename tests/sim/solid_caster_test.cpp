// tests/sim/solid_caster_test.cpp: single rays in space, against hand-worked distances and against
// the planar caster.
#include "sim/solid_caster.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "tests/sim/reference_world.hpp"
#include <gtest/gtest.h>

#include "sim/range_caster.hpp"

namespace sim {
namespace {

using algo::Obstacle;
using algo::Vec3;

constexpr double kDiagonal = std::numbers::sqrt2 / 2;
const Vec3 kDown45{kDiagonal, 0, -kDiagonal};

SolidCaster solids(const std::vector<Obstacle>& world) {
  SolidCaster caster;
  for (const Obstacle& obstacle : world) caster.add(obstacle);
  return caster;
}
double range(const SolidCaster& caster, const Vec3& from, const Vec3& way) {
  const auto hit = caster.cast(from, way, 50);
  return hit ? hit->range : 50;
}
Obstacle ramp(double x, double length, double low, double high, double heading = 0) {
  return {.id = 1, .pose_W = {x, 0, heading}, .shape = algo::Ramp{length, 2, low}, .height = high};
}
Obstacle trench(double x, double length, double depth) {
  return {.id = 2, .pose_W = {x, 0, 0}, .shape = algo::Trench{length, 2, depth}};
}

TEST(SolidCaster, TheFloorIsMetFromAboveOnly) {
  const SolidCaster caster = solids({});
  EXPECT_NEAR(range(caster, {0, 0, 0.2}, kDown45), 0.2 / kDiagonal, 1e-12);
  EXPECT_NEAR(range(caster, {0, 0, 0.2}, {0, 0, -1}), 0.2, 1e-12);
  EXPECT_EQ(range(caster, {0, 0, 0.2}, {1, 0, 0}), 50);
  EXPECT_EQ(range(caster, {0, 0, 0.2}, {kDiagonal, 0, kDiagonal}), 50);
}

TEST(SolidCaster, AStepIsMetOnItsTopAndOnItsRiser) {
  const SolidCaster caster = solids({ramp(1.5, 1, 0.013, 0.013)});  // from x = 1 to 2
  const auto top = caster.cast({1, 0, 0.2}, kDown45, 50);
  ASSERT_TRUE(top);
  EXPECT_NEAR(top->range, 0.187 / kDiagonal, 1e-12);
  EXPECT_NEAR((top->normal_W - Vec3(0, 0, 1)).norm(), 0, 1e-12);
  EXPECT_EQ(top->of->id, 1u);
  const auto riser = caster.cast({0.81, 0, 0.2}, kDown45, 50);  // 0.01 above the floor at x = 1
  ASSERT_TRUE(riser);
  EXPECT_NEAR(riser->range, 0.19 / kDiagonal, 1e-12);
  EXPECT_NEAR((riser->normal_W - Vec3(-1, 0, 0)).norm(), 0, 1e-12);
}

TEST(SolidCaster, ARampIsMetWhereItsPlaneIs) {
  for (const double degrees : {-20.0, -10.0, 5.0, 10.0, 20.0}) {
    const double tan = std::tan(degrees * std::numbers::pi / 180);
    // From x = 1 to 3, down from a height if the slope falls.
    const double low = tan < 0 ? -2 * tan : 0;
    const SolidCaster caster = solids({ramp(2, 2, low, low + 2 * tan)});
    const auto hit = caster.cast({1, 0, low + 0.3}, kDown45, 50);
    ASSERT_TRUE(hit);
    const double ahead = 0.3 / (1 + tan);
    EXPECT_NEAR(hit->range, ahead / kDiagonal, 1e-12) << degrees;
    EXPECT_NEAR((hit->normal_W - Vec3(-tan, 0, 1).normalized()).norm(), 0, 1e-12);
  }
}

TEST(SolidCaster, ATrenchHasABottomAndSides) {
  const SolidCaster wide = solids({trench(1, 0.5, 0.1)});
  EXPECT_NEAR(range(wide, {0.7, 0, 0.2}, kDown45), 0.3 / kDiagonal, 1e-12);  // its bottom
  const SolidCaster narrow = solids({trench(1, 0.02, 0.1)});                 // from 0.99 to 1.01
  const auto side = narrow.cast({0.8, 0, 0.2}, kDown45, 50);
  ASSERT_TRUE(side);
  EXPECT_NEAR(side->range, 0.21 / kDiagonal, 1e-12);
  EXPECT_NEAR((side->normal_W - Vec3(-1, 0, 0)).norm(), 0, 1e-12);
}

TEST(SolidCaster, ALevelRayAgreesWithThePlanarCaster) {
  std::mt19937_64 random(7);
  for (int world = 0; world < 50; ++world) {
    std::vector<Obstacle> obstacles;
    for (std::uint32_t id = 1; id <= 12; ++id) {
      const algo::Pose2 pose{reference::uniform(random, -6, 6),
                             reference::uniform(random, -6, 6),
                             reference::uniform(random, -3, 3)};
      if (std::hypot(pose.x, pose.y) < 1.5) continue;
      algo::Shape shape = algo::Cylinder{0.4};
      if (id % 3 == 1) shape = algo::Box{0.8, 0.5};
      if (id % 3 == 2) shape = algo::Wall{1.2, 0.1};
      obstacles.push_back({.id = id, .pose_W = pose, .shape = shape});
    }
    RangeCaster planar(0.3);
    for (const Obstacle& obstacle : obstacles) planar.add(obstacle);
    const SolidCaster caster = solids(obstacles);
    for (int k = 0; k < 50; ++k) {
      const double bearing = reference::uniform(random, -3, 3);
      std::vector<double> expected(1);
      planar.cast({0, 0, bearing}, {0, 1, 1}, 50, expected);
      const Vec3 way{std::cos(bearing), std::sin(bearing), 0};
      EXPECT_NEAR(range(caster, {0, 0, 0.3}, way), expected[0], 1e-9);
    }
  }
}

TEST(SolidCaster, ObstaclesCanBeMovedAndRemoved) {
  SolidCaster caster = solids({ramp(1.5, 1, 0.1, 0.1)});
  EXPECT_TRUE(caster.has_ground());
  const auto height = [&](double x) { return 1 - range(caster, {x, 0, 1}, {0, 0, -1}); };
  EXPECT_NEAR(height(1.5), 0.1, 1e-12);
  caster.move(1, {5, 0, 0});
  EXPECT_EQ(height(1.5), 0);
  EXPECT_NEAR(height(5), 0.1, 1e-12);
  caster.remove(1);
  caster.remove(1);
  EXPECT_FALSE(caster.has_ground());
  EXPECT_EQ(height(5), 0);
}

}  // namespace
}  // namespace sim
