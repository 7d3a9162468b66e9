// tests/algo/full_strip/building_memory_test.cpp: what is kept beyond the map, and comes back.
#include "algo/full_strip/building_memory.hpp"

#include <algorithm>
#include <numbers>

#include "tests/algo/full_strip/walls.hpp"
#include <gtest/gtest.h>

#include "algo/full_strip/mixed_beam.hpp"

namespace {

using algo::BuildingMemory;
using algo::LocalMap;
using algo::Vec2;

/// Half a turn ahead, nothing within range.
algo::LaserScan free_sweep() {
  algo::LaserScan scan;
  scan.angle_min = -std::numbers::pi / 2;
  scan.angle_increment = std::numbers::pi / 360;
  scan.range_max = 8;
  scan.resize(361);
  for (std::size_t i = 0; i < scan.size(); ++i) scan.set_free(i);
  return scan;
}

BuildingMemory::Cell cell(double x, double y) {
  return BuildingMemory::cell_of({x, y});
}

TEST(BuildingMemory, CountsTheBeamsThatCrossACell) {
  BuildingMemory memory;
  algo::LaserScan scan = free_sweep();
  scan.set_ok(180, 4.05);  // straight ahead
  for (int k = 0; k < 10; ++k) memory.look(scan, {0, 0.1, 0});
  EXPECT_TRUE(memory.seen(cell(3.5, 0.1)));
  EXPECT_TRUE(memory.seen(cell(5, 3)));
  EXPECT_FALSE(memory.seen(cell(-1, 0)));
  EXPECT_FALSE(memory.seen(cell(8.5, 0)));
  EXPECT_GT(memory.crossings(cell(1, 0.1)), memory.crossings(cell(6, 2)));
}

/// Along a wall beside the way at 0.5 m, through a door in it, and on along the wall behind it.
TEST(MixedBeam, AnEndBetweenAnEdgeAndTheWallBehindItIsNoSurface) {
  algo::LaserScan scan = free_sweep();
  for (std::size_t i = 170; i < 176; ++i) scan.set_ok(i, 4.2);
  for (std::size_t i = 178; i < 185; ++i) scan.set_ok(i, 5.3);
  for (const double share : {0.3, 0.5, 0.7}) {
    scan.set_ok(176, 4.2 + share * 1.1);
    scan.set_ok(177, 4.2 + share * 1.1);  // doubled
    EXPECT_EQ(algo::beam_end(scan, 176), algo::BeamEnd::Between) << share;
    EXPECT_EQ(algo::beam_end(scan, 177), algo::BeamEnd::Between) << share;
    EXPECT_EQ(algo::beam_end(scan, 173), algo::BeamEnd::Surface);
    EXPECT_EQ(algo::beam_end(scan, 182), algo::BeamEnd::Surface);
  }
}

/// Through a slit between a jamb and a wall behind it, into a lane. The end lies in the lane.
TEST(MixedBeam, AnEndBeyondASlitIsNoSurface) {
  algo::LaserScan scan = free_sweep();
  for (std::size_t i = 0; i < 181; ++i) scan.set_ok(i, 0.78);
  for (std::size_t i = 181; i < scan.size(); ++i) scan.set_ok(i, 2.15);
  scan.set_ok(180, 2.41);
  scan.set_ok(181, 2.65);
  EXPECT_EQ(algo::beam_end(scan, 180), algo::BeamEnd::Beyond);
  EXPECT_EQ(algo::beam_end(scan, 181), algo::BeamEnd::Beyond);
  EXPECT_EQ(algo::beam_end(scan, 177), algo::BeamEnd::Surface);
  EXPECT_EQ(algo::beam_end(scan, 184), algo::BeamEnd::Surface);
}

TEST(MixedBeam, TheCornerBetweenTwoWallsIsASurface) {
  for (const double turned : {0.1, 0.4, 0.8}) {
    algo::LaserScan scan = free_sweep();
    for (std::size_t i = 0; i < scan.size(); ++i) {
      const double to_one = 5 / std::cos(scan.angle(i) - turned);
      const double to_other = 3 / std::cos(scan.angle(i) - turned + std::numbers::pi / 2);
      const double ahead = to_one > 0 ? to_one : 100;
      const double range = std::min(ahead, to_other > 0 ? to_other : 100);
      if (range < scan.range_max) scan.set_ok(i, range);
    }
    for (std::size_t i = 0; i < scan.size(); ++i) {
      EXPECT_EQ(algo::beam_end(scan, i), algo::BeamEnd::Surface) << i << " turned by " << turned;
    }
  }
}

TEST(MixedBeam, ALegBeforeAWallIsASurface) {
  algo::LaserScan scan = free_sweep();
  for (std::size_t i = 0; i < scan.size(); ++i) scan.set_ok(i, 5);
  scan.set_ok(180, 4.2);
  for (std::size_t i = 0; i < scan.size(); ++i)
    EXPECT_EQ(algo::beam_end(scan, i), algo::BeamEnd::Surface) << i;
}

TEST(MixedBeam, AWallAcrossTheBeamsIsASurface) {
  algo::LaserScan scan = free_sweep();
  for (std::size_t i = 60; i < 300; ++i) scan.set_ok(i, 2 / std::cos(scan.angle(i)));
  for (std::size_t i = 0; i < scan.size(); ++i)
    EXPECT_EQ(algo::beam_end(scan, i), algo::BeamEnd::Surface) << i;
}

TEST(BuildingMemory, TellsWhatWasSeenFromNearby) {
  BuildingMemory memory;
  algo::LaserScan scan = free_sweep();
  for (std::size_t i = 170; i < 190; ++i) scan.set_ok(i, 2.1);
  for (int k = 0; k < 10; ++k) memory.look(scan, {0, 0.1, 0});
  EXPECT_TRUE(memory.seen_near(cell(1, 0.1)));
  EXPECT_TRUE(memory.seen_near(cell(2.1, 0.1))) << "where its beams end";
  EXPECT_TRUE(memory.seen_near(cell(0.1, 2.1)));
  EXPECT_FALSE(memory.seen_near(cell(2.7, 0.1))) << "behind it";
  EXPECT_FALSE(memory.seen_near(cell(0.1, 4))) << "seen from afar";
  memory.reset();
  EXPECT_FALSE(memory.seen_near(cell(1, 0.1)));
}

TEST(BuildingMemory, AMixedBeamRaisesDoubtsThatCrossingBeamsDispel) {
  BuildingMemory memory;
  algo::LaserScan scan = free_sweep();
  for (std::size_t i = 174; i < 180; ++i) scan.set_ok(i, 3);
  for (std::size_t i = 182; i < 188; ++i) scan.set_ok(i, 4.2);
  scan.set_ok(180, 3.6);
  scan.set_ok(181, 3.6);
  for (int k = 0; k < 4; ++k) memory.look(scan, {0, 0.1, 0});
  EXPECT_TRUE(memory.doubtful(cell(3.6, 0.1)));
  EXPECT_FALSE(memory.doubtful(cell(3.0, -0.2)));
  for (int k = 0; k < 40; ++k) memory.look(free_sweep(), {0, 0.1, 0});
  EXPECT_FALSE(memory.doubtful(cell(3.6, 0.1)));
}

TEST(BuildingMemory, ATileFarAwayGivesItsPlaceToANearerOne) {
  BuildingMemory memory;
  memory.get(3, 4).seen[0] = 1;
  EXPECT_NE(memory.find(3, 4), nullptr);
  memory.get(3 + BuildingMemory::kTiles, 4);
  EXPECT_EQ(memory.find(3, 4), nullptr);
  EXPECT_EQ(memory.find(3 + BuildingMemory::kTiles, 4)->seen[0], 0);
  memory.reset();
  EXPECT_EQ(memory.find(3 + BuildingMemory::kTiles, 4), nullptr);
}

/// The robot drives away until a wall has left the map, and comes back.
TEST(BuildingMemory, AWallIsOnTheMapAgainAfterAWayAround) {
  LocalMap map;
  BuildingMemory memory;
  map.reset({0, 0});
  walls::wall(map, {-3, 2}, {3, 2});
  for (double x = 0; x < 30; x += 0.5) map.follow({x, 0}, &memory);
  EXPECT_EQ(map.distance({0, 2}), LocalMap::kReach);  // it has left
  for (double x = 30; x > 0; x -= 0.5) map.follow({x, 0}, &memory);
  EXPECT_LT(map.distance({0, 2}), 0.06);
  EXPECT_NEAR(map.distance({1, 1.5}), 0.5, 0.06);
  EXPECT_NEAR(map.distance({3.5, 2}), 0.5, 0.06);
}

/// A wall that the robot saw vanish before it drove away does not come back.
TEST(BuildingMemory, TheMapIsRightWhereItIsNewer) {
  LocalMap map;
  BuildingMemory memory;
  map.reset({0, 0});
  walls::wall(map, {-3, 2}, {3, 2});
  const auto to_and_fro = [&] {
    for (double x = 0; x < 30; x += 0.5) map.follow({x, 0}, &memory);
    for (double x = 30; x > 0; x -= 0.5) map.follow({x, 0}, &memory);
  };
  to_and_fro();
  map.erase_near({0, 2}, 4, [](const Vec2&) { return true; });
  to_and_fro();
  EXPECT_EQ(map.distance({0, 2}), LocalMap::kReach);
}

TEST(BuildingMemory, TheCoarseLayerHoldsTheLargestClearance) {
  LocalMap map;
  BuildingMemory memory;
  map.reset({0, 0});
  walls::wall(map, {-3, 2}, {3, 2});
  map.survey(14 * 14, 0.37, true, memory);
  EXPECT_LE(memory.clearance(cell(0.1, 2.05)), 20);
  EXPECT_NEAR(memory.clearance(cell(0.1, 1.5)), 60, 8);
  EXPECT_EQ(memory.clearance(cell(0.1, -2)), 103);
  EXPECT_EQ(memory.clearance(cell(40, 0)), BuildingMemory::kUnknown);
}

/// It leaves out the tiles in which nothing has changed. Walls come and go, and the window moves.
TEST(BuildingMemory, ASurveyInTurnEndsAsOneOfTheWholeWindow) {
  LocalMap in_turn;
  LocalMap at_the_end;
  BuildingMemory layer;
  BuildingMemory whole;
  in_turn.reset({0, 0});
  at_the_end.reset({0, 0});
  const auto both = [&](const auto& change) {
    change(in_turn, layer);
    change(at_the_end, whole);
    for (int k = 0; k < 40; ++k) {
      in_turn.survey(8, 0.37, true, layer);
      for (LocalMap* const map : {&in_turn, &at_the_end}) map->insert({}, {}, {}, {});
    }
  };
  both([](LocalMap& map, BuildingMemory&) { walls::wall(map, {-3, 2}, {3, 2}); });
  both([](LocalMap& map, BuildingMemory&) { walls::wall(map, {-3, 1.3}, {3, 1.3}); });
  both([](LocalMap& map, BuildingMemory& memory) { map.follow({5, 0}, &memory); });
  both([](LocalMap& map, BuildingMemory&) { walls::wall(map, {1.6, -2}, {1.6, -1}); });
  both([](LocalMap& map, BuildingMemory&) {
    map.erase_near({0, 2}, 1.2, [](const Vec2&) { return true; });
  });
  at_the_end.survey(14 * 14, 0.37, true, whole);
  std::size_t narrow = 0;
  for (double x = -6; x < 15; x += 0.2) {
    for (double y = -9; y < 9; y += 0.2) {
      ASSERT_EQ(layer.clearance(cell(x, y)), whole.clearance(cell(x, y))) << x << ' ' << y;
      if (layer.clearance(cell(x, y)) < 100) ++narrow;
    }
  }
  EXPECT_GT(narrow, 100U);
}

/// A gap of `width` [m] in a wall along x, as the planner finds it from afar.
bool is_open_from_afar(double width, double at) {
  LocalMap map;
  BuildingMemory memory;
  map.reset({0, 0});
  for (int k = 0; k < 3; ++k) {
    walls::wall(map, {-3, 2}, {at - width / 2, 2});
    walls::wall(map, {at + width / 2, 2}, {3, 2});
  }
  map.survey(14 * 14, 0.37, true, memory);
  int most = 0;
  for (double x = at - 0.4; x < at + 0.4; x += 0.1) {
    most = std::max<int>(
        most, std::min(memory.clearance(cell(x, 2.01)), memory.clearance(cell(x, 1.99))));
  }
  return most >= 37;
}

/// Else the robot drives to a way that it finds shut as soon as it is near, turns back, and drives
/// there again: it once did so for a quarter of an hour.
TEST(BuildingMemory, AGapThatIsTooNarrowIsShutFromAfarToo) {
  for (const double at : {0.0, 0.03, 0.07, 0.11}) {
    for (const double width : {0.60, 0.64, 0.68}) {
      EXPECT_FALSE(is_open_from_afar(width, at)) << width << " m at " << at;
    }
    for (const double width : {0.80, 0.85, 1.0}) {
      EXPECT_TRUE(is_open_from_afar(width, at)) << width << " m at " << at;
    }
  }
}

/// The map of a way that turned out to lie 0.6 m farther north.
algo::MapMove moved_north() {
  algo::MapMove move;
  move.stations = {{{0, 0, 0}, {0, 0.6, 0}}, {{10, 0, 0}, {10, 0.6, 0}}};
  for (double x = 0; x < 10; x += 0.05) {
    move.walls_W.emplace_back(static_cast<float>(x + 0.02), 1.62F);
  }
  for (int column = 0; column < 50; ++column) {
    move.seen.push_back({.column = column, .row = 3, .beams = 9});
  }
  return move;
}

TEST(BuildingMemory, TakesTheMapAfterAMoveForAllThatItSaw) {
  BuildingMemory memory;
  memory.look(free_sweep(), {0, 0.1, 0});
  memory.drive({5, 0.1});
  memory.draw(moved_north());
  EXPECT_FALSE(memory.seen(cell(5, -3)));
  EXPECT_EQ(memory.crossings(cell(5, 0.7)), 9);
  EXPECT_TRUE(memory.driven(cell(5, 0.7)));
  EXPECT_FALSE(memory.driven(cell(5, 0.1)));
  const BuildingMemory::Tile* const tile = memory.find(3, 1);
  ASSERT_NE(tile, nullptr);
  EXPECT_EQ(tile->occupied[0], 0xffffffffU);  // from y = 1.6 m on
  EXPECT_EQ(tile->occupied[1], 0U);
}

}  // namespace
