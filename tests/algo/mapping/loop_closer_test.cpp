// tests/algo/mapping/loop_closer_test.cpp: which loops are believed, in rows of rooms of which some
// look alike.
#include "algo/mapping/loop_closer.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/algo/worlds.hpp"
#include <gtest/gtest.h>

namespace {

using algo::LoopCloser;
using algo::OccupancyMap;
using algo::Pose2;
using algo::PoseGraph;
using algo::Submap;
using algo::Vec2;

/// A room about the origin with four cupboards. Rooms of one look are the same.
worlds::World cupboard_room(int look) {
  worlds::World world;
  const double x = 3.2 + 0.5 * (3 * look % 4);
  const double y = 2.4 + 0.4 * (2 * look % 5);
  world.polygons = {{{-x, -y}, {x, -y}, {x, y}, {-x, y}}};
  for (int k = 0; k < 4; ++k) {
    const double a = 1.7 * look + 1.45 * k + 0.3 * std::sin(5.0 * look + k);
    const Vec2 p(2.6 * std::cos(a), 2 * std::sin(a));
    const double w = 0.3 + 0.15 * ((look + k) % 3);
    world.polygons.push_back({p, p + Vec2(w, 0), p + Vec2(w, 0.5), p + Vec2(0, 0.5)});
  }
  return world;
}

Submap seen_room(int look) {
  OccupancyMap map(0.05);
  const worlds::World world = cupboard_room(look);
  for (int k = 0; k < 12; ++k) {
    const double heading = algo::wrap_angle(2 * std::numbers::pi * k / 6);
    const Pose2 pose{0.3 * (k % 2), 0, heading};
    algo::LaserScan scan;
    worlds::scan_world(pose, world, 20, scan);
    map.insert(scan, pose, 20);
  }
  return Submap(map);
}

/// Drives from room to room.
class Tour {
 public:
  /// `deviation` [m] of the step from the room before. Whether the room closed a loop.
  bool visit(int look, const Pose2& pose_W, double deviation) {
    const std::size_t node = graph_.add(pose_W);
    if (node > 0) {
      const double heading = std::min(0.05, deviation / 10);
      graph_.add({.from = node - 1,
                  .to = node,
                  .step = algo::pose_step(graph_.pose(node - 1), pose_W),
                  .information = algo::Vec3(1 / (deviation * deviation),
                                            1 / (deviation * deviation),
                                            1 / (heading * heading))
                                     .asDiagonal()});
    }
    return closer_.take(node, seen_room(look), graph_);
  }
  const Pose2& pose(std::size_t node) const { return graph_.pose(node); }
  const LoopCloser& closer() const { return closer_; }

 private:
  PoseGraph graph_{};
  LoopCloser closer_{};
};

constexpr double kSure = 0.02;  // [m]
constexpr double kUnsure = 3;   // [m]

double metres_off(const Pose2& pose_W, const Vec2& p_W) {
  return (pose_W.position() - p_W).norm();
}

TEST(LoopCloser, OneRoomThatLooksAlikeIsNotBelievedButThreeInARowAre) {
  Tour tour;
  for (int k = 0; k < 4; ++k) EXPECT_FALSE(tour.visit(k + 1, {10.0 * k, 0, 0}, kSure));
  // Back to the first room, 2.5 m off.
  EXPECT_FALSE(tour.visit(1, {1.5, 2, 0}, kUnsure));
  EXPECT_FALSE(tour.visit(2, {11.5, 2, 0}, kSure));
  EXPECT_GT(metres_off(tour.pose(4), {0, 0}), 2);
  EXPECT_TRUE(tour.visit(3, {21.5, 2, 0}, kSure));
  EXPECT_LT(metres_off(tour.pose(4), {0, 0}), 0.05);
  EXPECT_LT(metres_off(tour.pose(6), {20, 0}), 0.05);
}

TEST(LoopCloser, RoomsInAnotherOrderAreNotBelieved) {
  Tour tour;
  for (int k = 0; k < 4; ++k) tour.visit(k + 1, {10.0 * k, 0, 0}, kSure);
  EXPECT_FALSE(tour.visit(3, {11.5, 2, 0}, kUnsure));
  EXPECT_FALSE(tour.visit(2, {21.5, 2, 0}, kSure));
  EXPECT_FALSE(tour.visit(1, {1.5, 2, 0}, kSure));
  EXPECT_TRUE(tour.closer().closed().empty());
}

TEST(LoopCloser, BetweenTwoCorridorsThatLookAlikeNoneIsChosen) {
  Tour tour;
  for (int k = 0; k < 3; ++k) tour.visit(k + 1, {10.0 * k, 0, 0}, kSure);
  tour.visit(7, {30, 4, 0}, kSure);
  for (int k = 0; k < 3; ++k) tour.visit(k + 1, {10.0 * k, 8, 0}, kSure);
  const std::size_t before = tour.closer().closed().size();
  // A third pass in the middle, open by more than the way to either.
  for (int k = 0; k < 3; ++k) {
    EXPECT_FALSE(tour.visit(k + 1, {10.0 * k, 4.2, 0}, k == 0 ? kUnsure : kSure)) << k;
  }
  EXPECT_EQ(tour.closer().closed().size(), before);
}

TEST(LoopCloser, AKnownPlaceIsTakenAtOnce) {
  Tour tour;
  for (int k = 0; k < 4; ++k) tour.visit(k + 1, {10.0 * k, 0, 0}, kSure);
  EXPECT_TRUE(tour.visit(1, {0.1, 0.1, 0}, 0.1));
  EXPECT_LT(metres_off(tour.pose(4), {0, 0}), 0.03);
}

/// A corridor 20 m long with a niche every 2 m, of which a robot that drives along +x (`sense` 1)
/// or -x (-1) sees the one side.
Submap seen_corridor(double sense) {
  OccupancyMap map(0.05);
  const auto see = [&](const Vec2& p, const algo::Facing& facing) {
    map.insert({p.x() - sense, 0}, p, facing);
  };
  for (const double wall : {-1.2, 1.2}) {
    const Vec2 inwards(0, wall > 0 ? -1 : 1);
    for (int k = -10; k < 10; k += 2) {
      const double left = k;
      const double side = sense > 0 ? left + 1 : left;  // of the niche, towards the robot
      for (double t = 0; t < 1; t += 0.04) {
        see({left + t, wall * 1.25}, {inwards, true});
        see({left + 1 + t, wall}, {inwards, true});
      }
      for (double t = 1; t < 1.25; t += 0.04) see({side, wall * t}, {{-sense, 0}, true});
    }
  }
  return Submap(map);
}

TEST(LoopCloser, OppositeSidesOfNichesDoNotHoldAPlaceAlongACorridor) {
  const Submap there = seen_corridor(1);
  const algo::FacedPoints back = seen_corridor(-1).thinned(0.1);
  const Pose2 guess{0.95, 0, 0};  // one side of each niche lies where the other was
  algo::ScanMatcher matcher;
  const auto told_along = [&] {
    const algo::ScanMatch match = matcher.match(there, guess, {0.1, 0.1});
    return match.points(0, 0) / match.points(1, 1);
  };
  matcher.take(back.points);
  EXPECT_GT(told_along(), 0.1);
  matcher.take(back);
  EXPECT_LT(told_along(), 0.02);
}

}  // namespace
