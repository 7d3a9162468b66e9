// tests/algo/mapping/facing_test.cpp: normals of returns, and which points may lie on one surface.
#include "algo/mapping/facing.hpp"

#include <numbers>
#include <vector>

#include "tests/algo/worlds.hpp"
#include <gtest/gtest.h>

namespace {

using algo::Facing;
using algo::Vec2;

TEST(Facing, OfAWallIsItsNormalTowardsTheScanner) {
  std::vector<Vec2> points;
  for (int k = -10; k <= 10; ++k) points.emplace_back(2, 0.05 * k);
  std::vector<Facing> facings;
  algo::find_facings(points, {0, 5}, facings);
  ASSERT_EQ(facings.size(), points.size());
  for (const Facing& facing : facings) {
    EXPECT_TRUE(facing.normal);
    EXPECT_NEAR(facing.side.x(), -1, 1e-12);
  }
  algo::find_facings(points, {4, 0}, facings);
  EXPECT_NEAR(facings[10].side.x(), 1, 1e-12);
}

TEST(Facing, OfALonelyReturnIsTheDirectionToTheScanner) {
  const std::vector<Vec2> points{{3, 4}, {6, 8}};
  std::vector<Facing> facings;
  algo::find_facings(points, {0, 0}, facings);
  for (const Facing& facing : facings) {
    EXPECT_FALSE(facing.normal);
    EXPECT_NEAR((facing.side - Vec2(-0.6, -0.8)).norm(), 0, 1e-12);
  }
}

TEST(Facing, OppositeSidesAreNeverOneSurface) {
  const Facing east{{1, 0}, true};
  EXPECT_TRUE(may_be_one(east, east));
  EXPECT_FALSE(may_be_one(east, {{-1, 0}, true}));
  EXPECT_FALSE(may_be_one(east, {{-0.1, 0.99}, false}));
  // The corner of a niche: two normals tell, a direction does not.
  EXPECT_FALSE(may_be_one(east, {{0.3, 0.95}, true}));
  EXPECT_TRUE(may_be_one(east, {{0.3, 0.95}, false}));
  EXPECT_TRUE(may_be_one(east, Facing{}));
}

TEST(Facing, FollowsTheFrame) {
  const Facing turned = Facing{{1, 0}, true}.turned(std::numbers::pi / 2);
  EXPECT_TRUE(turned.normal);
  EXPECT_NEAR((turned.side - Vec2(0, 1)).norm(), 0, 1e-12);
}

TEST(FacedPoints, AreTheOkBeamsUpToTheReach) {
  worlds::World room;
  room.polygons = {{{-3, -2}, {3, -2}, {3, 2}, {-3, 2}}};
  algo::LaserScan scan;
  worlds::scan_world({}, room, 20, scan);
  scan.status[0] = algo::Beam::Free;
  algo::FacedPoints seen;
  seen.take(scan, {1, 1, std::numbers::pi / 2}, 2.5);
  ASSERT_EQ(seen.points.size(), seen.facings.size());
  EXPECT_LT(seen.points.size(), scan.size());
  EXPECT_GT(seen.points.size(), 20U);
  for (std::size_t i = 0; i < seen.points.size(); ++i) {
    EXPECT_LE((seen.points[i] - Vec2(1, 1)).norm(), 2.5 + 1e-12);
    EXPECT_GT(seen.facings[i].side.dot(Vec2(1, 1) - seen.points[i]), 0);
  }
}

}  // namespace
