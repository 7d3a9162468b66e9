// tests/algo/arm/known_things_test.cpp: declared pieces, and what a scan shows beside them.
#include "algo/arm/known_things.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace {

using algo::KnownThings;
using algo::LaserScan;
using algo::Obstacle;
using algo::Vec3;

constexpr double kPlane = 0.30;  // [m] of the scan

/// Nothing within range at all of 181 bearings.
LaserScan empty_scan() {
  LaserScan scan;
  scan.angle_min = -std::numbers::pi / 2;
  scan.angle_increment = std::numbers::pi / 180;
  scan.range_max = 8;
  scan.resize(181);
  for (std::size_t i = 0; i < scan.size(); ++i) scan.set_free(i);
  return scan;
}

/// A surface at `range` [m] straight ahead, `wide` beams to either side.
LaserScan surface_ahead(double range, std::size_t wide) {
  LaserScan scan = empty_scan();
  for (std::size_t i = 90 - wide; i <= 90 + wide; ++i) scan.set_ok(i, range);
  return scan;
}

/// Seen from a robot at `here`.
void see(KnownThings& known, const LaserScan& scan, const algo::Pose2& here = {}) {
  const algo::Pose2 sensor_W = compose(here, scan.mount_R);
  std::vector<algo::Vec2> points_W;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    points_W.push_back(to_parent(sensor_W, scan.ranges[i] * algo::direction(scan.angle(i))));
  }
  known.see(scan, sensor_W, points_W);
}

double distance(const KnownThings& known, const Vec3& p_W) {
  double least = INFINITY;
  for (const algo::Solid& solid : known.all()) {
    least = std::min(least, distance_to(solid, p_W).distance);
  }
  return least;
}

Obstacle table(std::uint32_t id, double x) {
  return {
      .id = id, .pose_W = {x, 0, 0}, .shape = algo::Box{0.6, 0.6}, .height = 0.75, .bottom = 0.70};
}

TEST(KnownThings, DeclaredPiecesHaveTheirHeights) {
  KnownThings known;
  known.reset(std::vector{table(1, 2)}, kPlane);
  EXPECT_NEAR(distance(known, {2, 0, 0.60}), 0.10, 1e-12);
  EXPECT_NEAR(distance(known, {2, 0, 0.85}), 0.10, 1e-12);
  EXPECT_LT(distance(known, {2, 0, 0.72}), 0);
}

TEST(KnownThings, EditsOfPeopleCountAndAPieceThatMovesByItselfDoesNot) {
  KnownThings known;
  known.reset({}, kPlane);
  known.apply(algo::AddObstacle{table(1, 2)});
  known.apply(algo::MoveObstacle{1, {3, 0, 0}});
  EXPECT_NEAR(distance(known, {2, 0, 0.72}), 0.7, 1e-12);
  Obstacle walks = table(2, 1);
  walks.path = algo::ObstaclePath{1, 0, {{0, {1, 0}}}};
  known.apply(algo::AddObstacle{walks});
  EXPECT_EQ(known.all().size(), 1U);
  known.apply(algo::RemoveObstacle{1});
  EXPECT_TRUE(known.all().empty());
}

TEST(KnownThings, WhatAScanShowsBesideThemReachesFromTheFloorUpwards) {
  KnownThings known;
  known.reset({}, kPlane);
  const algo::Pose2 here{1, 0, std::numbers::pi / 2};
  see(known, surface_ahead(2, 2), here);
  ASSERT_EQ(known.all().size(), 1U);
  for (const double z : {0.05, 1.2}) {
    EXPECT_LT(distance(known, {1, 2.0 + KnownThings::kDepth / 2, z}), 0);
    EXPECT_NEAR(distance(known, {1, 1.5, z}), 0.5 - KnownThings::kRound, 0.01);
  }
  see(known, empty_scan(), here);
  EXPECT_TRUE(known.all().empty());
}

TEST(KnownThings, WhatIsSeenMovesUntilTheNextScanAndADeclaredPieceNever) {
  KnownThings known;
  known.reset(std::vector{table(1, 2)}, kPlane);
  see(known, surface_ahead(1, 5));
  EXPECT_FALSE(known.set_moving({5, 0}, 0.5, {0.3, 0}));
  EXPECT_TRUE(known.set_moving({1.5, 0}, 0.7, {0.3, 0}));
  EXPECT_TRUE(known.all()[0].velocity_W.isZero());
  for (const algo::Solid& piece : known.all().subspan(1)) EXPECT_EQ(piece.velocity_W.x(), 0.3);
  see(known, surface_ahead(1, 5));
  for (const algo::Solid& piece : known.all()) EXPECT_TRUE(piece.velocity_W.isZero());
}

TEST(KnownThings, ALoneReturnAndOneOfADeclaredPieceAddNothing) {
  KnownThings known;
  Obstacle post{.id = 1, .pose_W = {2.1, 0, 0}, .shape = algo::Cylinder{0.1}, .height = 0.5};
  known.reset(std::vector{post}, kPlane);
  see(known, surface_ahead(2, 2));
  EXPECT_EQ(known.all().size(), 1U);
  see(known, surface_ahead(4, 0));
  EXPECT_EQ(known.all().size(), 1U);
  // Of a piece that the plane does not cut nothing can return.
  known.reset(std::vector{table(1, 2.1)}, kPlane);
  see(known, surface_ahead(2, 2));
  EXPECT_EQ(known.all().size(), 2U);
}

TEST(KnownThings, ALongSurfaceIsCutAndEachScannerKeepsItsOwn) {
  KnownThings known;
  known.reset({}, kPlane);
  LaserScan back = surface_ahead(3, 2);
  back.mount_R = {-0.2, 0, std::numbers::pi};
  see(known, surface_ahead(2, 20));
  see(known, back);
  const std::size_t both = known.all().size();
  EXPECT_GT(both, 5U);
  see(known, empty_scan());
  EXPECT_EQ(known.all().size(), 1U);
  std::vector<algo::Solid> near;
  known.find_near({0, 0}, 1, near);
  EXPECT_TRUE(near.empty());
  known.find_near({-2.5, 0}, 1, near);
  EXPECT_EQ(near.size(), 1U);
}

}  // namespace
