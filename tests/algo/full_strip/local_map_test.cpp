// tests/algo/full_strip/local_map_test.cpp: occupied and freed cells, and distances.
#include "algo/full_strip/local_map.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/algo/worlds.hpp"
#include <gtest/gtest.h>

namespace {

using algo::LaserScan;
using algo::LocalMap;
using algo::Pose2;
using algo::Vec2;

/// Scans `world` from `pose` and enters it `times` times.
void see(LocalMap& map, const worlds::World& world, const Pose2& pose, int times = 1) {
  LaserScan scan;
  worlds::scan_world(pose, world, 8.0, scan);
  std::vector<Vec2> points(scan.size(), Vec2(0, 0));
  for (std::size_t i = 0; i < scan.size(); ++i) {
    points[i] = algo::to_parent(pose, scan.ranges[i] * algo::direction(scan.angle(i)));
  }
  for (int k = 0; k < times; ++k) map.insert(scan, pose, points, {});
}

/// Occupied cells of the whole window.
std::size_t occupied(const LocalMap& map) {
  std::size_t count = 0;
  constexpr double kHalf = LocalMap::kSize * LocalMap::kCell / 2;
  const Vec2 middle_W = map.corner_W() + Vec2(kHalf, kHalf);
  map.each_near(middle_W, 1.1 * kHalf, [&](const Vec2&) { ++count; });
  return count;
}

worlds::World post(double x, double y, double radius) {
  return {{{{x, y}, radius}}, {}};
}

TEST(LocalMap, DistancesAreToTheSurfaceSeen) {
  LocalMap map;
  see(map, post(2, 0, 0.3), {0, 0, 0}, 3);
  EXPECT_GT(occupied(map), 5U);
  for (double x = 0.9; x < 1.6; x += 0.05) {
    EXPECT_NEAR(map.distance({x, 0}), std::min(1.0, 1.7 - x), 0.04) << x;
  }
  EXPECT_EQ(map.distance({0, 2}), LocalMap::kReach);
  EXPECT_EQ(map.distance({1000, 0}), LocalMap::kReach);
}

TEST(LocalMap, WithoutDistancesItHoldsTheSameSurfaces) {
  LocalMap with;
  LocalMap without(LocalMap::Distances::None);
  const auto surfaces = [](const LocalMap& map) {
    std::vector<double> out;
    map.each_near({2, 0}, 2, [&](const Vec2& p) { out.insert(out.end(), {p.x(), p.y()}); });
    return out;
  };
  for (LocalMap* map : {&with, &without}) {
    see(*map, post(2, 0, 0.3), {0, 0, 0}, 3);
    map->follow({6, 0});  // moves the window
    see(*map, {{{{6, 0}, 0.5}}, {}}, {0, 0, 0}, 5);
  }
  EXPECT_FALSE(surfaces(with).empty());
  EXPECT_EQ(surfaces(with), surfaces(without));
  EXPECT_EQ(occupied(with), occupied(without));
}

LaserScan three_beams() {
  LaserScan scan;
  scan.angle_increment = 0.01;
  scan.range_max = 8;
  scan.resize(3);
  return scan;
}

TEST(LocalMap, OneStrayHitIsNoObstacle) {
  LocalMap map;
  LaserScan scan = three_beams();
  for (std::size_t i = 0; i < 3; ++i) scan.set_free(i);
  scan.set_ok(1, 1.0);
  const std::vector<Vec2> points{{0, 0}, {1, 0}, {0, 0}};
  map.insert(scan, {}, points, {});
  EXPECT_EQ(occupied(map), 0U);
  map.insert(scan, {}, points, {});
  EXPECT_EQ(occupied(map), 1U);
}

TEST(LocalMap, CellsThatBeamsPassBecomeFreeAndDistancesGrow) {
  LocalMap map;
  see(map, post(2, 0, 0.3), {0, 0, 0}, 5);
  const worlds::World empty{{{{6, 0}, 0.5}}, {}};
  see(map, empty, {0, 0, 0}, 30);
  EXPECT_EQ(map.distance({1.6, 0}), LocalMap::kReach);
}

TEST(LocalMap, AMovedWindowKeepsItsContents) {
  LocalMap map;
  see(map, post(2, 0, 0.3), {0, 0, 0}, 3);
  const std::size_t before = occupied(map);
  const double near = map.distance({1.5, 0.05});
  ASSERT_TRUE(map.follow({4.1, -4.3}));
  EXPECT_EQ(occupied(map), before);
  EXPECT_DOUBLE_EQ(map.distance({1.5, 0.05}), near);
  EXPECT_FALSE(map.follow({4.1, -4.3}));
  ASSERT_TRUE(map.follow({40, 0}));
  EXPECT_EQ(occupied(map), 0U);
}

TEST(LocalMap, WhatEntersTheWindowHasItsDistanceToWhatStays) {
  LocalMap map;
  see(map, post(0, 0, 0.3), {2, 0, std::numbers::pi}, 3);
  map.follow({12.4, 0});  // the window begins at x = 0, and the side seen of the post is inside
  ASSERT_GT(occupied(map), 5U);
  map.follow({0, 0});
  EXPECT_NEAR(map.distance({0.7, 0}), 0.4, 0.05);
  EXPECT_NEAR(map.distance({-0.3, 0}), 0.5, 0.1);  // on the side that had left the window
}

TEST(LocalMap, TheDistancesDoNotDependOnTheOrderOfEvents) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-3, 3);
  LocalMap map;
  for (int round = 0; round < 12; ++round) {
    see(map, post(place(random), place(random), 0.2), {place(random), place(random), 0}, 6);
  }
  const worlds::World empty{{{{20, 0}, 0.5}}, {}};
  for (int k = 0; k < 40; ++k) see(map, empty, {0, 0, 0.1 * k});  // until all rebuilds are done
  for (int k = 0; k < 500; ++k) {
    const Vec2 p{place(random), place(random)};
    double least = LocalMap::kReach;
    map.each_near(p, 1.1, [&](const Vec2& q) { least = std::min(least, (q - p).norm()); });
    EXPECT_NEAR(map.distance(p), least, 0.05) << p.transpose();
  }
}

/// Cells that no beam passes fade, and then count as unseen. Once they were for a while neither
/// occupied nor unseen, and a robot backed into them.
TEST(LocalMap, FadingCellsAreNeverFree) {
  LocalMap map;
  see(map, post(1.5, 0, 0.3), {0, 0, 0}, 6);
  const Vec2 front{1.2, 0};
  ASSERT_TRUE(map.seen().seen(front));
  bool faded = false;
  for (int k = 0; k < 1500; ++k) {
    see(map, {}, {0, 0, std::numbers::pi});
    const bool occupied = map.distance(front) < 0.08;
    ASSERT_TRUE(occupied || !map.seen().seen(front)) << "after " << k << " scans";
    faded = faded || !occupied;
  }
  EXPECT_TRUE(faded);
}

/// The end of a lane that no beam reaches stays, however far the robot drives, until it is asked to
/// forget it: else the robot would look at the ends of lanes in turn for ever.
TEST(LocalMap, ByWayOldCellsStayUntilTheyAreForgotten) {
  LocalMap map(LocalMap::Distances::Kept, LocalMap::Ageing::ByWay);
  constexpr double kOld = 5;  // [m]
  map.remember_for(static_cast<std::uint16_t>(kOld / LocalMap::kWayUnit));
  const Vec2 front{1.2, 0};
  const Vec2 later{-1.2, 0};
  see(map, post(1.5, 0, 0.3), {0, 0, 0}, 6);
  for (int k = 0; k < 600; ++k) {
    map.follow({0, 0.1 * (k % 2)});
    see(map, {}, {0, 0, std::numbers::pi});
  }
  EXPECT_LT(map.distance(front), 0.08);
  see(map, post(-1.5, 0, 0.3), {0, 0, std::numbers::pi}, 6);
  map.forget_old();
  for (int k = 0; k < 60; ++k) see(map, {}, {0, 5, 0});  // until all rebuilds are done
  EXPECT_EQ(map.distance(front), LocalMap::kReach);
  EXPECT_FALSE(map.seen().seen(front));
  EXPECT_LT(map.distance(later), 0.08) << "seen lately";
}

/// A single return may be a stray, but the cell must not count as free.
TEST(LocalMap, SuspectedCellsAreNotFree) {
  LocalMap map;
  LaserScan scan = three_beams();
  for (std::size_t i = 0; i < 3; ++i) scan.set_ok(i, 1.02 + 0.1 * static_cast<double>(i));
  std::vector<Vec2> points(scan.size(), Vec2(0, 0));
  for (std::size_t i = 0; i < 3; ++i) {
    points[i] = scan.ranges[i] * algo::direction(scan.angle(i));
  }
  for (int k = 0; k < 2; ++k) {
    map.insert(scan, {}, points, {});
    EXPECT_EQ(occupied(map), k == 0 ? 0U : 3U);
    for (const Vec2& point : points) EXPECT_EQ(map.seen().seen(point), k == 1);
    EXPECT_TRUE(map.seen().seen({0.9, 0.01}));
  }
}

TEST(LocalMap, ErasesNearAPoint) {
  LocalMap map;
  see(map, post(2, 0, 0.3), {0, 0, 0}, 3);
  map.erase_near({2, 0}, 1, [](const Vec2&) { return true; });
  EXPECT_EQ(occupied(map), 0U);
  // Seen again it is occupied again, and is freed no faster than the first time.
  see(map, post(2, 0, 0.3), {0, 0, 0}, 5);
  LocalMap fresh;
  see(fresh, post(2, 0, 0.3), {0, 0, 0}, 5);
  EXPECT_EQ(occupied(map), occupied(fresh));
  const worlds::World empty{{{{6, 0}, 0.5}}, {}};
  for (int k = 0; k < 6; ++k) {
    see(map, empty, {0, 0, 0});
    see(fresh, empty, {0, 0, 0});
    EXPECT_NEAR(static_cast<double>(occupied(map)), static_cast<double>(occupied(fresh)), 8);
  }
}

TEST(LocalMap, DrawsTheWallsOfAMapInPlaceOfItsOwn) {
  LocalMap map;
  see(map, post(2, 0, 0.3), {0, 0, 0}, 3);
  const std::vector<Eigen::Vector2f> walls_W{{1.51F, 0.02F}, {500, 0}};
  map.draw({0, 0}, walls_W);
  EXPECT_EQ(occupied(map), 1U);
  EXPECT_NEAR(map.distance({1, 0}), 0.5, 0.05);
  map.each_near({1.5, 0}, 0.2, [](const Vec2& p_W) {
    EXPECT_NEAR(p_W.x(), 1.51, 1e-5);
    EXPECT_NEAR(p_W.y(), 0.02, 1e-5);
  });
}

TEST(LocalMap, ItsWindowsOverAMemoryCoverAllOfIt) {
  algo::BuildingMemory memory;
  for (const Vec2& p_W : {Vec2(-31, 4), Vec2(47, -22)}) memory.drive(p_W);
  const std::vector<Vec2> middles_W = LocalMap::windows_over(memory);
  constexpr double kHalf = LocalMap::kInner * algo::BuildingMemory::kTileEdge / 2;
  for (const Vec2& p_W : {Vec2(-31, 4), Vec2(47, -22), Vec2(0, 0)}) {
    EXPECT_TRUE(std::ranges::any_of(middles_W, [&](const Vec2& middle_W) {
      return (p_W - middle_W).cwiseAbs().maxCoeff() <= kHalf;
    })) << p_W.transpose();
  }
}

}  // namespace
