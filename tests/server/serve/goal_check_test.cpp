// tests/server/serve/goal_check_test.cpp: goals in walls and out of reach are reported.
#include "server/serve/goal_check.hpp"

#include <chrono>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace server {
namespace {

algo::RobotSpec disc() {
  algo::RobotSpec spec;
  spec.radius = 0.35;
  return spec;
}

algo::Obstacle wall(double x0, double y0, double x1, double y1) {
  const algo::Vec2 a(x0, y0), b(x1, y1);
  const algo::Vec2 middle = (a + b) / 2;
  return {.pose_W = {middle.x(), middle.y(), std::atan2(y1 - y0, x1 - x0)},
          .shape = algo::Wall{(b - a).norm(), 0.1}};
}

/// A square room about (`x`, 0), 3 m wide, with a door of `gap` in its left wall.
std::vector<algo::Obstacle> room(double x, double gap) {
  std::vector<algo::Obstacle> out{wall(x - 1.5, -1.5, x + 1.5, -1.5),
                                  wall(x + 1.5, -1.5, x + 1.5, 1.5),
                                  wall(x - 1.5, 1.5, x + 1.5, 1.5)};
  const double half = gap / 2;
  out.push_back(wall(x - 1.5, -1.5, x - 1.5, -half));
  out.push_back(wall(x - 1.5, half, x - 1.5, 1.5));
  return out;
}

std::string said(const algo::Vec2& goal, const std::vector<algo::Obstacle>& obstacles) {
  return goal_trouble(disc(), {goal, {}}, {}, obstacles).value_or("");
}

TEST(GoalCheckTest, AGoalInsideOrTooNearAnObstacleIsReported) {
  const std::vector<algo::Obstacle> post{{.pose_W = {3, 0, 0}, .shape = algo::Cylinder{0.3}}};
  EXPECT_EQ(said({3.1, 0}, post), "The goal lies inside an obstacle.");
  EXPECT_EQ(said({3.5, 0}, post),
            "The robot does not fit there: an obstacle is 0.20 m from the goal, and it needs 0.35 "
            "m.");
  EXPECT_EQ(said({3.7, 0}, post), "");
  EXPECT_EQ(said({3.7, 0}, {}), "");
}

TEST(GoalCheckTest, AGoalBehindClosedWallsIsReported) {
  const std::string shut =
      "There is no way there: obstacles shut it off for a robot of this width.";
  EXPECT_EQ(said({4, 0}, room(4, 0)), shut);
  EXPECT_EQ(said({4, 0}, room(4, 0.4)), shut);
  EXPECT_EQ(said({4, 0}, room(4, 1.0)), "");
  EXPECT_EQ(said({8, 0}, room(4, 0)), "");      // round it
  EXPECT_EQ(said({8, 0}, room(0, 0)), shut);    // the robot itself is shut in
  EXPECT_EQ(said({0.5, 0.5}, room(0, 0)), "");  // with its goal
}

TEST(GoalCheckTest, AWorldOfThousandsIsCheckedWithinAFrame) {
  std::vector<algo::Obstacle> many;
  for (int i = 0; i < 2000; ++i) {
    many.push_back({.pose_W = {50, 50, 0}, .shape = algo::Cylinder{40.0 - 0.001 * i}});
  }
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(said({99, 99}, many), "");
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(2));
}

TEST(GoalCheckTest, TheScanShowsObstaclesOnOrBeforeTheGoal) {
  algo::LaserScan scan;
  scan.range_max = 8;
  scan.angle_min = -std::numbers::pi / 2;
  scan.angle_increment = std::numbers::pi / 180;
  scan.resize(181);
  for (std::size_t i = 0; i < scan.size(); ++i) scan.set_free(i);
  const algo::Pose2 pose_W{1, 1, std::numbers::pi / 2};  // looks along y
  const auto told = [&](double x, double y) {
    return goal_trouble(disc(), {{x, y}, {}}, pose_W, scan).value_or("");
  };
  EXPECT_EQ(told(1, 5), "");
  scan.set_ok(90, 4.1);  // straight ahead, at (1, 5.1)
  EXPECT_NE(told(1, 5).find("sees something 0.10 m from the goal"), std::string::npos)
      << told(1, 5);
  EXPECT_NE(told(1, 7).find("behind something that the scanner sees at 4.1 m"), std::string::npos);
  EXPECT_EQ(told(1, 3), "");
  EXPECT_NE(told(1, -2).find("does not look that way"), std::string::npos);
  EXPECT_NE(told(3, 20).find("sees 8.0 m"), std::string::npos) << told(3, 20);
}

}  // namespace
}  // namespace server
