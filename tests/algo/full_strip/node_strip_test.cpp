// tests/algo/full_strip/node_strip_test.cpp: nodes of the strip where it is narrow.
#include "algo/full_strip/node_strip.hpp"

#include <cmath>

#include "tests/algo/full_strip/walls.hpp"
#include <gtest/gtest.h>

namespace {

using algo::LocalMap;
using algo::NodeStrip;
using algo::Vec2;

/// A lane along x, from -1 m to 3 m, and a strip in it `off` [m] from its middle line.
struct Lane {
  LocalMap map{};
  NodeStrip strip{};
  algo::StripSettings settings{.least_clearance = 0.35};

  Lane(double width, double off) {
    for (int k = 0; k < 4; ++k) {
      for (const double side : {-width / 2, width / 2}) walls::wall(map, {-1, side}, {3, side});
    }
    algo::Recycled<Vec2> path;
    path.push_back({0, off});
    path.push_back({2, off});
    strip.lay(path);
  }
};

TEST(NodeStrip, ItIsCentredInANarrowLane) {
  for (const double off : {-0.03, 0.02, 0.04}) {
    Lane lane(0.8, off);
    lane.strip.centre(lane.map, lane.settings);
    for (std::size_t i = 1; i < 10; ++i) {
      EXPECT_NEAR(lane.strip.nodes()[i].position_W.y(), 0, 0.004) << off << ", node " << i;
    }
  }
}

TEST(NodeStrip, RobotAndGoalStayWhereTheyAre) {
  Lane lane(0.8, 0.03);
  lane.strip.centre(lane.map, lane.settings);
  EXPECT_EQ(lane.strip.nodes()[0].position_W, Vec2(0, 0.03));
  EXPECT_EQ(lane.strip.end_W(), Vec2(2, 0.03));
}

TEST(NodeStrip, WhereThereIsRoomTheForcesAlonePlaceIt) {
  Lane lane(1.2, 0.05);
  lane.strip.centre(lane.map, lane.settings);
  for (const algo::Node& node : lane.strip.nodes()) EXPECT_EQ(node.position_W.y(), 0.05);
}

/// A thing on one side alone is no narrow place.
TEST(NodeStrip, BesideAWallItIsNotCentred) {
  LocalMap map;
  for (int k = 0; k < 4; ++k) walls::wall(map, {-1, 0.38}, {3, 0.38});
  NodeStrip strip;
  algo::Recycled<Vec2> path;
  path.push_back({0, 0});
  path.push_back({2, 0});
  strip.lay(path);
  strip.centre(map, {.least_clearance = 0.35});
  for (const algo::Node& node : strip.nodes()) EXPECT_EQ(node.position_W.y(), 0);
}

}  // namespace
