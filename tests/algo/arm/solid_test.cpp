// tests/algo/arm/solid_test.cpp: distances to upright solids, and their shadows along a way.
#include "algo/arm/solid.hpp"

#include <random>

#include <gtest/gtest.h>

namespace {

using algo::Solid;
using algo::Vec2;
using algo::Vec3;

Solid post_at(double x, double y, double radius, double bottom, double top) {
  Solid post;
  post.centre_W = {x, y};
  post.rounding = radius;
  post.bottom = bottom;
  post.top = top;
  return post;
}

TEST(Solid, DistancesToEachSideOfAPost) {
  const Solid post = post_at(1, 2, 0.5, 0.2, 1.2);
  EXPECT_NEAR(distance_to(post, {3, 2, 1}).distance, 1.5, 1e-12);
  EXPECT_NEAR(distance_to(post, {1, 2.2, 1.7}).distance, 0.5, 1e-12);
  EXPECT_NEAR(distance_to(post, {1, 2, 0.1}).distance, 0.1, 1e-12);
  EXPECT_NEAR(distance_to(post, {1.5 + 0.3, 2, 1.6}).distance, 0.5, 1e-12);  // from the rim
  EXPECT_NEAR(distance_to(post, {1.4, 2, 0.7}).distance, -0.1, 1e-12);
  EXPECT_NEAR(distance_to(post, {1, 2, 1.15}).distance, -0.05, 1e-12);
  EXPECT_EQ(distance_to(post, {1, 2.2, 1.7}).away, Vec3::UnitZ());
  EXPECT_EQ(distance_to(post, {1, 2, 0.1}).away, -Vec3::UnitZ());
}

TEST(Solid, TheDirectionIsTheSlopeOfTheDistance) {
  Solid box = post_at(0.3, -0.2, 0.05, 0.4, 0.9);
  box.axis_W = algo::direction(0.7);
  box.half = {0.4, 0.15};
  std::mt19937 random{3};
  std::uniform_real_distribution<double> place{-1.5, 1.5};
  constexpr double kStep = 1e-6;
  for (int n = 0; n < 500; ++n) {
    const Vec3 p(place(random), place(random), place(random));
    const auto here = distance_to(box, p);
    EXPECT_NEAR(here.away.norm(), 1, 1e-12);
    if (here.distance < 0) continue;  // inside it has edges
    for (Eigen::Index k = 0; k < 3; ++k) {
      Vec3 step = Vec3::Zero();
      step[k] = kStep;
      const double slope =
          (distance_to(box, p + step).distance - distance_to(box, p - step).distance) / (2 * kStep);
      EXPECT_NEAR(slope, here.away[k], 1e-4);
    }
  }
}

TEST(Solid, TheNearestPlaceOfALinkIsTheLeastOfAll) {
  Solid box = post_at(0.3, -0.2, 0.1, 0.4, 0.9);
  box.axis_W = algo::direction(-0.4);
  box.half = {0.3, 0.1};
  std::mt19937 random{5};
  std::uniform_real_distribution<double> place{-1.2, 1.2};
  for (int n = 0; n < 300; ++n) {
    const Vec3 a(place(random), place(random), place(random));
    const Vec3 b(place(random), place(random), place(random));
    const auto found = nearest_on_link(a, b, box);
    EXPECT_NEAR(distance_to(box, found.point_W).distance, found.distance, 1e-12);
    constexpr int kPlaces = 400;
    for (int k = 0; k <= kPlaces; ++k) {
      EXPECT_GE(distance_to(box, a + (b - a) * k / kPlaces).distance, found.distance - 1e-5);
    }
  }
}

TEST(Solid, AShadowReachesAlongTheWayAndOutwards) {
  const Solid post = post_at(2, -0.8, 0.1, 0, 1.5);
  const Solid shadow = solid_shadow(post, Vec2::UnitX(), {0, -0.2});
  EXPECT_NEAR(distance_to(shadow, {0, -0.5, 1}).distance, 0.2, 1e-12);
  EXPECT_EQ(distance_to(shadow, {0, -0.5, 1}).away, Vec3::UnitY());
  EXPECT_LT(distance_to(shadow, {0, -1.4, 1}).distance, 0);               // beyond the post
  EXPECT_NEAR(distance_to(shadow, {0, -1.4, 1.7}).distance, 0.2, 1e-12);  // over it
  const Solid other = solid_shadow(post, Vec2::UnitX(), {0, -1.2});
  EXPECT_LT(distance_to(other, {0, -0.5, 1}).distance, 0);
  EXPECT_NEAR(gap_along({0, 0, 1}, {0.5, -1, 1}, post, Vec2::UnitX()), 1.4, 1e-12);
  EXPECT_LT(gap_along({1.5, 0, 1}, {2.5, -1, 1}, post, Vec2::UnitX()), 0);
}

TEST(Solid, EachObstacleOccupiesItsOutlineUpToItsHeight) {
  algo::Obstacle obstacle;
  obstacle.pose_W = {1, 2, 0.5};
  obstacle.height = 0.7;
  std::vector<Solid> solids;
  std::mt19937 random{9};
  std::uniform_real_distribution<double> place{-3, 3};
  const std::vector<Vec2> triangle{{-0.5, -0.5}, {0.7, 0}, {-0.5, 0.5}};
  for (const algo::Shape& shape : {algo::Shape{algo::Cylinder{0.4}},
                                   algo::Shape{algo::Box{0.8, 0.3}},
                                   algo::Shape{algo::Wall{2, 0.1}},
                                   algo::Shape{algo::Polygon{triangle}}}) {
    obstacle.shape = shape;
    solids.clear();
    append_solids(obstacle, solids);
    for (int n = 0; n < 200; ++n) {
      const Vec2 p(place(random), place(random));
      const double expected = signed_distance(obstacle, p);
      if (expected < 0) continue;
      double least = 1e9;
      for (const Solid& solid : solids) {
        EXPECT_EQ(solid.top, 0.7);
        least = std::min(least, distance_to(solid, {p.x(), p.y(), 0.3}).distance);
      }
      EXPECT_NEAR(least, expected, 1e-9);
    }
  }
  solids.clear();
  obstacle.shape = algo::Ramp{1, 1, 0};
  append_solids(obstacle, solids);
  EXPECT_TRUE(solids.empty());
}

}  // namespace
