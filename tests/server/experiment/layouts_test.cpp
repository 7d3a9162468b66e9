// tests/server/experiment/layouts_test.cpp: random layouts keep their gaps and stand in the way.
#include "server/experiment/layouts.hpp"

#include <algorithm>
#include <numbers>
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
      const sim::Scenario layout = random_layout(obstacles, 0.3, i);
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
  EXPECT_EQ(random_layout(3, 0.3, 7).obstacles, random_layout(3, 0.3, 7).obstacles);
  EXPECT_NE(random_layout(3, 0.3, 7).obstacles, random_layout(3, 0.3, 8).obstacles);
  EXPECT_EQ(random_layout(2, 0.6, 12).name, "random-2-0012");
}

}  // namespace
}  // namespace server::experiment
