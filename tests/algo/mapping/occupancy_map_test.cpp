// tests/algo/mapping/occupancy_map_test.cpp: the effect of beams on cells.
#include "algo/mapping/occupancy_map.hpp"

#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace {

using algo::Facing;
using algo::LaserScan;
using algo::OccupancyMap;
using algo::Vec2;

/// One beam ahead; a second one, without a reading, so that there is a step between two.
LaserScan beam(double range) {
  LaserScan scan;
  scan.angle_increment = 0.1;
  scan.range_max = 8;
  scan.resize(2);
  scan.set_ok(0, range);
  scan.set_invalid(1, algo::BeamCode::NoEcho);
  return scan;
}

OccupancyMap::Tally ahead(const OccupancyMap& map, double x) {
  return map.at(map.cell_of({x, 0.01}));
}

TEST(OccupancyMap, ABeamPassesThroughCellsAndHitsTheLast) {
  OccupancyMap map(0.1);
  map.insert(beam(1.02), {0.05, 0.01, 0}, 8);
  EXPECT_EQ(ahead(map, 1.05).hits, 1);
  EXPECT_EQ(ahead(map, 1.05).passes, 0);
  for (double x : {0.05, 0.15, 0.55, 0.95}) {
    EXPECT_EQ(ahead(map, x).passes, 1) << x;
    EXPECT_EQ(ahead(map, x).hits, 0) << x;
  }
  EXPECT_FALSE(ahead(map, 1.15).known());
}

TEST(OccupancyMap, ReturnsBeyondReachClearTheWayOnly) {
  OccupancyMap map(0.1);
  map.insert(beam(1.5), {0, 0.01, 0}, 1.0);
  EXPECT_EQ(ahead(map, 0.55).passes, 1);
  EXPECT_FALSE(ahead(map, 1.5).known());
}

TEST(OccupancyMap, AVanishedObstacleIsNoLongerOccupied) {
  OccupancyMap map(0.1);
  for (int k = 0; k < 3; ++k) map.insert(beam(1.05), {0, 0.01, 0}, 8);
  EXPECT_TRUE(ahead(map, 1.05).occupied());
  EXPECT_EQ(ahead(map, 1.05).hits, 3);
  for (int k = 0; k < 20; ++k) map.insert(beam(1.85), {0, 0.01, 0}, 8);
  EXPECT_FALSE(ahead(map, 1.05).occupied());
  EXPECT_EQ(ahead(map, 1.05).hits, 3);
  EXPECT_EQ(ahead(map, 1.05).passes, 20);
}

TEST(OccupancyMap, OccupiedCellsLieAtTheMeanOfTheirHits) {
  OccupancyMap map(0.1);
  map.insert(beam(1.02), {0, 0.01, 0}, 8);
  map.insert(beam(1.06), {0, 0.01, 0}, 8);
  std::vector<Vec2> seen;
  map.each_near({1, 0}, 0.2, [&](const Vec2& p_W) { seen.push_back(p_W); });
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_NEAR(seen[0].x(), 1.04, 1e-6);
  EXPECT_NEAR(seen[0].y(), 0.01, 1e-6);
  map.each_near({100, 100}, 0.2, [&](const Vec2& p_W) { seen.push_back(p_W); });
  EXPECT_EQ(seen.size(), 1U);
}

TEST(OccupancyMap, HasNoEdgeAndTakesMemoryWhereItSees) {
  OccupancyMap map(0.05);
  map.insert(beam(2), {-5000, 3000, 0}, 8);
  const std::size_t one = map.bytes();
  map.insert(beam(2), {-5000, 3000, 0}, 8);
  EXPECT_EQ(map.bytes(), one);
  map.insert(beam(2), {5000, -3000, 0}, 8);
  EXPECT_LE(map.bytes(), 3 * one);
  EXPECT_EQ(map.at(map.cell_of({5002, -3000})).hits, 1);
  EXPECT_EQ(map.at(map.cell_of({-4998, 3000})).hits, 2);
  EXPECT_EQ(map.at(map.cell_of({-4998.5, 3000})).passes, 2);
  std::size_t cells = 0;
  map.each_cell([&](const OccupancyMap::Index&, const OccupancyMap::Tally& tally) {
    if (tally.known()) ++cells;
  });
  EXPECT_GT(cells, 60U);
  EXPECT_LT(cells, 100U);
}

/// Whether a point that faces `side_W` finds the cell at (2.05, 0.05).
bool faces(const OccupancyMap& map, const Vec2& side_W) {
  bool met = false;
  map.each_facing({2.05, 0.05}, {side_W.normalized()}, 0.02, [&](const Vec2&) { met = true; });
  return met;
}

TEST(OccupancyMap, ACellFacesTheSideThatItWasSeenFrom) {
  OccupancyMap map(0.1);
  map.insert({1, 0}, {2.05, 0.05}, Facing{{-1, 0}});
  EXPECT_TRUE(faces(map, {-1, 0}));
  EXPECT_TRUE(faces(map, {-0.1, 3}));
  EXPECT_FALSE(faces(map, {1, 0}));
  EXPECT_FALSE(faces(map, {0.1, 3}));
}

TEST(OccupancyMap, ACellSeenFromBothSidesFacesBoth) {
  OccupancyMap map(0.1);
  for (int k = 0; k < 20; ++k) {
    map.insert({1, 0}, {2.05, 0.05}, Facing{{-1, 0}});
    map.insert({3, 0}, {2.05, 0.05}, Facing{{1, 0}});
  }
  EXPECT_TRUE(faces(map, {-1, 0}));
  EXPECT_TRUE(faces(map, {1, 0}));
}

TEST(OccupancyMap, ACellWithoutANormalFacesAllSides) {
  OccupancyMap map(0.1);
  map.insert({1, 0}, {2.05, 0.05});
  EXPECT_TRUE(faces(map, {1, 0}));
}

TEST(OccupancyMap, AScanTellsHowItsWallsFace) {
  OccupancyMap map(0.1);
  map.insert(beam(2.05), {0, 0.05, 0}, 8);
  EXPECT_TRUE(faces(map, {-1, 0}));
  EXPECT_FALSE(faces(map, {1, 0}));
}

TEST(OccupancyMap, MovesEachCellWithTheStationItWasSeenFrom) {
  OccupancyMap map(0.1);
  map.set_station(0);
  for (int k = 0; k < 3; ++k) map.insert({0, 0.01}, {1.05, 0.01}, {Vec2(-1, 0), true});
  map.set_station(1);
  for (int k = 0; k < 3; ++k) map.insert({10, 0.01}, {11.05, 0.01}, {Vec2(-1, 0), true});
  const std::vector<algo::StationMove> moves{{{0, 0, 0}, {0, 0, 0}},
                                             {{10, 0, 0}, {10, 0.5, std::numbers::pi / 2}}};
  const OccupancyMap moved = map.moved(moves);
  EXPECT_EQ(ahead(moved, 1.05).hits, 3);
  EXPECT_EQ(ahead(moved, 0.55).passes, 3);
  EXPECT_FALSE(ahead(moved, 11.05).known());
  const OccupancyMap::Tally turned = moved.at(moved.cell_of({9.99, 1.55}));
  EXPECT_EQ(turned.hits, 3);
  EXPECT_LT(turned.facing().side.y(), -0.9);
  EXPECT_EQ(turned.station, 1);
}

TEST(OccupancyMap, AWallThatMovesKeepsItsCell) {
  OccupancyMap map(0.1);
  for (int k = 0; k < 2; ++k) map.insert({0, 0.01}, {1.02, 0.01});
  for (int k = 0; k < 50; ++k) map.insert({0, 0.01}, {0.92, 0.55});  // passes beside it
  const std::vector<algo::StationMove> moves{{{0, 0, 0}, {0.04, 0, 0.02}}};
  std::size_t walls = 0;
  map.moved(moves).each_cell([&](const OccupancyMap::Index&, const OccupancyMap::Tally& tally) {
    walls += tally.occupied() ? 1U : 0U;
  });
  EXPECT_EQ(walls, 2U);
}

TEST(OccupancyMap, AddsWhatAnotherMapCounted) {
  OccupancyMap map(0.1);
  OccupancyMap other(0.1);
  for (int k = 0; k < 3; ++k) map.insert(beam(1.02), {0, 0.01, 0}, 8);
  other.insert(beam(1.06), {0, 0.01, 0}, 8);
  map.add(other);
  const OccupancyMap::Tally sum = ahead(map, 1.05);
  EXPECT_EQ(sum.hits, 4);
  EXPECT_NEAR(map.mean_W(map.cell_of({1.05, 0.01}), sum).x(), 1.03, 1e-6);
  EXPECT_EQ(ahead(map, 0.55).passes, 4);
}

TEST(OccupancyMap, TracesTheWallsOfAnotherAsIfHitOnce) {
  OccupancyMap other(0.1);
  other.set_station(5);
  for (int k = 0; k < 3; ++k) other.insert(beam(1.02), {0, 0.01, 0}, 8);
  OccupancyMap map(0.1);
  map.trace(other, {0, 0}, 2);
  EXPECT_EQ(ahead(map, 1.05).hits, 1);
  EXPECT_EQ(ahead(map, 1.05).station, 5);
  EXPECT_NEAR(map.mean_W(map.cell_of({1.05, 0.01}), ahead(map, 1.05)).x(), 1.02, 1e-6);
  EXPECT_FALSE(ahead(map, 0.55).known());
  OccupancyMap elsewhere(0.1);
  elsewhere.trace(other, {5, 0}, 2);
  EXPECT_EQ(elsewhere.bytes(), 0U);
}

TEST(OccupancyMap, SeesAsFarAsTheNextWall) {
  OccupancyMap map(0.1);
  map.mark_wall({1, 0.01});
  EXPECT_TRUE(map.sees({0, 0.01}, {0.9, 0.01}));
  EXPECT_FALSE(map.sees({0, 0.01}, {2, 0.01}));
  EXPECT_TRUE(map.sees({0, 0.5}, {2, 0.5}));
}

}  // namespace
