// tests/algo/obstacle_test.cpp: outlines, distances and invalid shapes.
#include "algo/obstacle.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "tests/algo/not_finite.hpp"
#include <gtest/gtest.h>

namespace {

using algo::Box;
using algo::Cylinder;
using algo::Obstacle;
using algo::Polygon;
using algo::Vec2;
using algo::Wall;

using tests::kNan;

Obstacle at(const algo::Pose2& pose, const algo::Shape& shape) {
  Obstacle obstacle;
  obstacle.pose_W = pose;
  obstacle.shape = shape;
  return obstacle;
}

Obstacle polygon(std::vector<Vec2> points) {
  return at({}, Polygon{std::move(points)});
}

TEST(Outline, IsInTheWorldAndCounterClockwise) {
  // A box of 2 x 1 m turned by 90 degrees about (3, 4): its x axis is W's y axis.
  const auto points = algo::outline_W(at({3, 4, std::numbers::pi / 2}, Box{2, 1}));
  const std::vector<Vec2> expected = {{3.5, 3}, {3.5, 5}, {2.5, 5}, {2.5, 3}};
  ASSERT_EQ(points.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_LT((points[i] - expected[i]).norm(), 1e-12) << i;
  EXPECT_TRUE(algo::outline_W(at({}, Cylinder{1})).empty());
  EXPECT_EQ(algo::outline_W(at({1, 0, 0}, Wall{4, 0.2})).front(), Vec2(-1, -0.1));
  EXPECT_EQ(algo::outline_W(at({1, 1, 0}, Polygon{{{0, 0}, {1, 0}, {0, 1}}}))[1], Vec2(2, 1));
}

TEST(SignedDistance, OfEveryShape) {
  EXPECT_NEAR(algo::signed_distance(at({1, 1, 0}, Cylinder{0.5}), {4, 5}), 4.5, 1e-12);  // 3-4-5
  EXPECT_NEAR(algo::signed_distance(at({1, 1, 0}, Cylinder{0.5}), {1, 1}), -0.5, 1e-12);
  // Beyond the corner (1, 0.5) of a 2 x 1 box by (3, 4).
  EXPECT_NEAR(algo::signed_distance(at({}, Box{2, 1}), {4, 4.5}), 5, 1e-12);
  EXPECT_NEAR(algo::signed_distance(at({}, Box{2, 1}), {0.9, 0}), -0.1, 1e-12);
  EXPECT_NEAR(algo::signed_distance(at({}, Box{2, 1}), {0, 0}), -0.5, 1e-12);
  EXPECT_NEAR(algo::signed_distance(at({}, Wall{4, 0.2}), {0, 1}), 0.9, 1e-12);
  const Obstacle triangle = polygon({{0, 0}, {2, 0}, {0, 2}});
  EXPECT_NEAR(algo::signed_distance(triangle, {1, -3}), 3, 1e-12);
  EXPECT_NEAR(algo::signed_distance(triangle, {2, 2}), std::sqrt(2.0), 1e-12);  // to x + y = 2
  EXPECT_NEAR(algo::signed_distance(triangle, {0.5, 0.3}), -0.3, 1e-12);
  EXPECT_NEAR(algo::signed_distance(triangle, {-3, -4}), 5, 1e-12);
}

/// A box equals the polygon of its corners.
TEST(SignedDistance, BoxAndItsPolygonAgree) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> anywhere(-3, 3);
  for (int k = 0; k < 200; ++k) {
    const algo::Pose2 pose{anywhere(random), anywhere(random), anywhere(random)};
    const Obstacle box = at(pose, Box{1.4, 0.6});
    const Obstacle same = at({}, Polygon{algo::outline_W(box)});
    const Vec2 p{anywhere(random), anywhere(random)};
    EXPECT_NEAR(algo::signed_distance(box, p), algo::signed_distance(same, p), 1e-12);
    EXPECT_EQ(algo::defect(same), std::nullopt);
  }
}

TEST(Defect, ValidShapesHaveNone) {
  EXPECT_EQ(algo::defect(at({}, Cylinder{0.3})), std::nullopt);
  EXPECT_EQ(algo::defect(at({}, Box{1000, 0.001})), std::nullopt);
  EXPECT_EQ(algo::defect(at({}, Wall{4, 0.1})), std::nullopt);
  EXPECT_EQ(algo::defect(polygon({{0, 0}, {1, 0}, {1, 1}, {0, 1}})), std::nullopt);
  // A point in the middle of an edge changes nothing.
  EXPECT_EQ(algo::defect(polygon({{0, 0}, {1, 0}, {2, 0}, {1, 1}})), std::nullopt);
}

struct Refused {
  Obstacle obstacle{};
  std::string says{};
};

std::vector<Refused> refused() {
  Obstacle low = at({}, Cylinder{1});
  low.height = 0;
  Obstacle dark = at({}, Cylinder{1});
  dark.reflectivity = 0.01;
  Obstacle unlit = at({}, Cylinder{1});
  unlit.reflectivity = kNan;
  std::vector<Vec2> many;
  for (int i = 0; i < 300; ++i) many.emplace_back(algo::direction(i * 2 * std::numbers::pi / 300));
  std::vector<Vec2> star;  // every other corner of a pentagon: left turns only, two rounds
  for (int i = 0; i < 5; ++i) star.emplace_back(algo::direction(i * 4 * std::numbers::pi / 5));
  return {
      {at({}, Cylinder{0}), "radius must be above 0"},
      {at({}, Cylinder{-1}), "radius must be above 0"},
      {at({}, Cylinder{kNan}), "radius must be a finite number"},
      {at({}, Cylinder{1001}), "radius must be at most 1000 m"},
      {at({}, Box{1, 0}), "width must be above 0"},
      {at({}, Box{0, 1}), "length must be above 0"},
      {at({}, Wall{1, 0}), "thickness must be above 0"},
      {at({kNan, 0, 0}, Cylinder{1}), "x, y and heading"},
      {at({0, 0, std::numeric_limits<double>::infinity()}, Cylinder{1}), "x, y and heading"},
      {low, "height must be above 0"},
      {dark, "reflectivity"},
      {unlit, "reflectivity"},
      {polygon({}), "at least 3 points, this one has 0"},
      {polygon({{0, 0}, {1, 0}}), "at least 3 points, this one has 2"},
      {polygon({{0, 0}, {1, 0}, {1, 0}, {0, 1}}), "point 2 and point 3"},
      {polygon({{0, 0}, {1, kNan}, {0, 1}}), "point 2 of the polygon must be finite"},
      {polygon({{0, 0}, {2000, 0}, {0, 1}}), "point 2 of the polygon is more than 1000 m"},
      {polygon({{0, 0}, {1, 0}, {2, 0}}), "one line"},
      {polygon({{0, 0}, {2, 2}, {1, 1}}), "one line"},
      {polygon({{0, 0}, {0, 1}, {1, 1}, {1, 0}}), "clockwise"},
      {polygon({{0, 0}, {2, 0}, {2, 2}, {1, 0.5}, {0, 2}}), "not convex at point 4"},
      {polygon({{0, 2}, {1, 0.5}, {2, 2}, {2, 0}, {0, 0}}), "not convex at point 2"},
      {polygon({{0, 0}, {1, 1}, {1, 0}, {0, 1}}), "crosses itself"},
      {polygon(star), "crosses itself"},
      {polygon(many), "at most 256 points, this one has 300"},
  };
}

TEST(Defect, ErrorsAreSentences) {
  for (const Refused& each : refused()) {
    const auto said = algo::defect(each.obstacle);
    ASSERT_TRUE(said.has_value()) << "accepted: " << each.says;
    EXPECT_NE(said->find(each.says), std::string::npos) << *said << " instead of " << each.says;
  }
}

}  // namespace
