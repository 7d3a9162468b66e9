// tests/algo/mapping/path_polish_test.cpp: a path that is right already stays right.
#include "algo/mapping/path_polish.hpp"

#include <cmath>
#include <random>
#include <vector>

#include "tests/algo/mapping/rooms.hpp"
#include <gtest/gtest.h>

namespace {

using algo::LaserScan;
using algo::Pose2;
using algo::Vec2;

/// A corridor of 70 m by 2.4 m, with shallow niches at uneven distances on both sides.
worlds::World niched_corridor() {
  std::vector<Vec2> outline{{-5, -1.2}};
  for (double x = -2; x < 62; x += 4.3 + 1.7 * std::sin(x)) {
    for (const Vec2& p : {Vec2(x, -1.2), Vec2(x, -1.4), Vec2(x + 1, -1.4), Vec2(x + 1, -1.2)}) {
      outline.push_back(p);
    }
  }
  outline.insert(outline.end(), {{65, -1.2}, {65, 1.2}});
  for (double x = 61; x > -3; x -= 4.9 + 1.3 * std::cos(x)) {
    for (const Vec2& p : {Vec2(x, 1.2), Vec2(x, 1.5), Vec2(x - 0.9, 1.5), Vec2(x - 0.9, 1.2)}) {
      outline.push_back(p);
    }
  }
  outline.emplace_back(-5, 1.2);
  worlds::World world;
  world.polygons = {outline};
  return world;
}

TEST(PolishPath, ATruePathStaysWhereItIs) {
  const worlds::World world = niched_corridor();
  std::mt19937 bits(5);
  std::vector<Pose2> path_W;
  std::vector<LaserScan> scans;
  for (double x = 0; x < 55; x += 0.15) {
    path_W.push_back({x, 0.2 * std::sin(0.3 * x), std::atan(0.06 * std::cos(0.3 * x))});
    LaserScan& scan = scans.emplace_back();
    worlds::scan_world(path_W.back(), world, 30, scan);
    for (double& range : scan.ranges) {
      range += 0.04 * (static_cast<double>(bits()) / 4294967295.0 - 0.5);
    }
  }
  const std::vector<Pose2> polished_W = algo::polish_path(path_W, scans, {});
  ASSERT_EQ(polished_W.size(), path_W.size());
  for (std::size_t k = 0; k < path_W.size(); ++k) {
    EXPECT_LT((polished_W[k].position() - path_W[k].position()).norm(), 0.08) << k;
    EXPECT_LT(std::abs(polished_W[k].heading - path_W[k].heading), 0.01) << k;
  }
}

}  // namespace
