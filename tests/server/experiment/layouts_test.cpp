// tests/server/experiment/layouts_test.cpp: random layouts keep their gaps and stand in the way.
#include "server/experiment/layouts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include <gtest/gtest.h>

namespace server::experiment {
namespace {

using algo::Vec2;

algo::Obstacle at(double x, double y, double heading, algo::Shape shape) {
  algo::Obstacle obstacle;
  obstacle.pose_W = {x, y, heading};
  obstacle.shape = std::move(shape);
  return obstacle;
}

TEST(SurfaceGap, BetweenCylindersAndBoxes) {
  const algo::Obstacle post = at(0, 0, 0, algo::Cylinder{0.3});
  EXPECT_NEAR(surface_gap(post, at(2, 0, 0, algo::Cylinder{0.5})), 1.2, 1e-12);
  const algo::Obstacle box = at(2, 0, 0, algo::Box{1.0, 0.6});
  EXPECT_NEAR(surface_gap(post, box), 1.2, 1e-12);
  EXPECT_NEAR(surface_gap(box, post), 1.2, 1e-12);
  // A square of side sqrt 2 on its corner reaches 1 m: from x = 5 to 4; the box ends at 2.5.
  const double side = std::numbers::sqrt2;
  const algo::Obstacle corner = at(5, 0, std::numbers::pi / 4, algo::Box{side, side});
  EXPECT_NEAR(surface_gap(box, corner), 1.5, 1e-9);
  EXPECT_NEAR(surface_gap(corner, box), 1.5, 1e-9);
  EXPECT_LT(surface_gap(box, at(2, 0, std::numbers::pi / 2, algo::Box{1.0, 0.6})), 0);  // a cross
}

TEST(RandomLayouts, KeepTheirGapsAndBlockTheWay) {
  for (const std::size_t obstacles : {2U, 3U, 4U}) {
    for (std::size_t i = 1; i <= 40; ++i) {
      const sim::Scenario layout = random_layout({.obstacles = obstacles}, i);
      ASSERT_EQ(layout.obstacles.size(), obstacles);
      bool blocks = false;
      for (std::size_t a = 0; a < obstacles; ++a) {
        for (std::size_t b = a + 1; b < obstacles; ++b) {
          EXPECT_GE(surface_gap(layout.obstacles[a], layout.obstacles[b]), kFreeGap);
        }
        EXPECT_GE(signed_distance(layout.obstacles[a], {0, 0}), kFreeRoom);
        EXPECT_GE(signed_distance(layout.obstacles[a], layout.goal->position_W), kFreeRoom);
      }
      for (int step = 0; step <= 1000; ++step) {
        const Vec2 p = layout.goal->position_W * (step / 1000.0);
        blocks = blocks || std::ranges::any_of(layout.obstacles, [&](const algo::Obstacle& o) {
                   return signed_distance(o, p) < kLaneHalf;
                 });
      }
      EXPECT_TRUE(blocks) << layout.name;
    }
  }
}

TEST(RandomLayouts, TheSameNumberIsTheSameLayout) {
  EXPECT_EQ(random_layout({}, 7).obstacles, random_layout({}, 7).obstacles);
  EXPECT_NE(random_layout({}, 7).obstacles, random_layout({}, 8).obstacles);
  EXPECT_EQ(random_layout({.obstacles = 2, .repulsion_gain = 0.6}, 12).name, "random-2-0012");
}

TEST(RandomLayouts, SmallerGapsLetMoreObstaclesIn) {
  const sim::Scenario dense = random_layout({.obstacles = 9, .gap = 0.4}, 1);
  EXPECT_EQ(dense.name, "random-9-gap400-0001");
  ASSERT_EQ(dense.obstacles.size(), 9U);
  double least = 1e9;
  for (std::size_t a = 0; a < 9; ++a) {
    for (std::size_t b = a + 1; b < 9; ++b) {
      least = std::min(least, surface_gap(dense.obstacles[a], dense.obstacles[b]));
    }
  }
  EXPECT_GE(least, 0.4);
  EXPECT_LT(least, kFreeGap);
}

TEST(RandomLayouts, ObstaclesStandAsNearToTheLineAsAskedFor) {
  const LayoutRules near{.aside = 0.8};
  EXPECT_EQ(random_layout(near, 3).name, "random-3-aside800-0003");
  for (std::size_t i = 1; i <= 20; ++i) {
    const sim::Scenario layout = random_layout(near, i);
    const Vec2 along = layout.goal->position_W.normalized();
    for (const algo::Obstacle& each : layout.obstacles) {
      const Vec2 at_W = each.pose_W.position();
      EXPECT_LE(std::abs(along.x() * at_W.y() - along.y() * at_W.x()), near.aside + 1e-9);
    }
  }
}

TEST(RandomLayouts, RulesThatCannotHoldAreRefused) {
  try {
    random_layout({.obstacles = 12, .gap = 3.0}, 1);
    FAIL() << "12 obstacles with 3 m between them";
  } catch (const std::runtime_error& e) {
    EXPECT_STREQ(
        e.what(),
        "12 obstacles with free gaps of 3 m find no place within 2 m of the straight line");
  }
}

}  // namespace
}  // namespace server::experiment
