// tests/algo/mapping/station_graph_test.cpp: stations along a way, and the way fitted to a loop.
#include "algo/mapping/station_graph.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace {

using algo::OccupancyMap;
using algo::Pose2;
using algo::StationGraph;
using algo::StationMove;
using algo::Vec2;

/// A wall from (x, low) to (x, high).
void build(OccupancyMap& map, double x, double low, double high) {
  for (double y = low; y <= high; y += map.cell_edge() / 2) map.mark_wall({x, y});
}

TEST(StationGraph, GrowsWithTheGroundAndNotWithTheWay) {
  const OccupancyMap map(0.05);
  StationGraph stations;
  stations.reset({0, 0, 0});
  const auto drive = [&](bool back) {
    for (int k = 0; k <= 40; ++k) {
      const double x = 0.25 * (back ? 40 - k : k);
      stations.drive({x, 0, back ? std::numbers::pi : 0.0}, 0, map);
    }
  };
  drive(false);
  const std::size_t there = stations.size();
  EXPECT_GE(there, 4U);
  EXPECT_LE(there, 7U);
  for (int lap = 0; lap < 3; ++lap) {
    drive(true);
    drive(false);
  }
  EXPECT_EQ(stations.size(), there);
}

TEST(StationGraph, DoesNotPassAStationBehindAWall) {
  OccupancyMap map(0.05);
  build(map, 0.5, -5, 5);
  StationGraph stations;
  stations.reset({0, 0, 0});
  EXPECT_FALSE(stations.drive({0, 0.9, 0}, 0, map));  // passes it
  // Beyond the wall it is as near, yet the way there is another one.
  stations.drive({0.2, 6, 0}, 0, map);
  stations.drive({1, 6, 0}, 0, map);
  EXPECT_TRUE(stations.drive({1, 0, 0}, 0, map));
}

/// Around a square of 20 m, its ways measured 2 % too long and each turn 0.02 rad too wide.
TEST(StationGraph, SpreadsTheErrorOfALoopOverTheWay) {
  const OccupancyMap map(0.05);
  StationGraph stations;
  stations.reset({0, 0, 0});
  Pose2 pose_W{0, 0, 0};
  for (int side = 0; side < 4; ++side) {
    for (int k = 0; k < 80; ++k) {
      pose_W = compose(pose_W, {0.25 * 1.02, 0, 0});
      stations.drive(pose_W, 1, map);
    }
    pose_W = compose(pose_W, {0, 0, std::numbers::pi / 2 + 0.02});
  }
  ASSERT_GT(pose_W.position().norm(), 0.7);
  const std::size_t before = stations.here();
  ASSERT_TRUE(stations.recognise(pose_W, {0, 0, 0}, 1, map));
  EXPECT_FALSE(stations.recognise(pose_W, {0, 0, 0}, 1, map)) << "it is known";
  const std::vector<StationMove> moves = stations.fit();
  ASSERT_EQ(moves.size(), stations.size());
  EXPECT_EQ(moves[0].to_W, Pose2({0, 0, 0}));
  const Pose2 end_W = compose(moves[before].to_W, pose_step(moves[before].from_W, pose_W));
  EXPECT_LT(end_W.position().norm(), 0.1);
  // No step of the way takes more than its share.
  for (std::size_t k = 1; k < moves.size(); ++k) {
    const double was = (moves[k].from_W.position() - moves[k - 1].from_W.position()).norm();
    const double is = (moves[k].to_W.position() - moves[k - 1].to_W.position()).norm();
    EXPECT_NEAR(is, was, 0.06) << k;
  }
}

}  // namespace
