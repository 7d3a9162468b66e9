// tests/algo/mapping/pose_graph_test.cpp: loops, scale errors of the odometry, and false edges.
#include "algo/mapping/pose_graph.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "algo/mapping/step_edges.hpp"

namespace {

using algo::GraphEdge;
using algo::OdometryChain;
using algo::Pose2;
using algo::PoseGraph;

Eigen::Matrix3d surveyed_info() {
  return algo::Vec3(400, 400, 1e4).asDiagonal();
}

/// Poses on a circle of 10 m, `turn` apart, their odometry wrong by these shares.
struct RoundWay {
  std::vector<Pose2> true_W{};
  PoseGraph graph{};
};

RoundWay round_way(int poses, double distance_error, double turn_error) {
  RoundWay out;
  Pose2 guess_W{};
  for (int k = 0; k < poses; ++k) {
    const double a = 2 * std::numbers::pi * k / poses;
    out.true_W.push_back({10 * std::sin(a), 10 - 10 * std::cos(a), algo::wrap_angle(a)});
    if (k == 0) {
      out.graph.add(guess_W);
      continue;
    }
    Pose2 step = algo::pose_step(out.true_W[out.true_W.size() - 2], out.true_W.back());
    step = {step.x * (1 + distance_error),
            step.y * (1 + distance_error),
            step.heading * (1 + turn_error)};
    guess_W = algo::compose(guess_W, step);
    OdometryChain odometry;
    odometry.add(step);
    const std::size_t node = out.graph.add(guess_W);
    out.graph.add(odometry.edge(node - 1, node));
  }
  return out;
}

GraphEdge surveyed_loop(const RoundWay& way, std::size_t from, std::size_t to) {
  return {.from = from,
          .to = to,
          .step = algo::pose_step(way.true_W[from], way.true_W[to]),
          .information = surveyed_info(),
          .doubt = 4};
}

double worst_pose(const RoundWay& way) {
  double most = 0;
  for (std::size_t k = 0; k < way.true_W.size(); ++k) {
    most = std::max(most, (way.graph.pose(k).position() - way.true_W[k].position()).norm());
  }
  return most;
}

TEST(PoseGraph, LoopsTellTheScaleErrorsOfTheOdometry) {
  RoundWay way = round_way(60, 0.05, -0.04);
  EXPECT_GT(worst_pose(way), 1.5);
  way.graph.add(surveyed_loop(way, 0, 59));
  way.graph.add(surveyed_loop(way, 0, 30));
  way.graph.solve();
  EXPECT_LT(worst_pose(way), 0.1);
  EXPECT_NEAR(way.graph.scale().distance, 1 / 1.05 - 1, 0.015);
  EXPECT_NEAR(way.graph.scale().turn, 1 / 0.96 - 1, 0.015);
}

TEST(PoseGraph, OneFalseLoopAmongTrueOnesMovesNothing) {
  RoundWay way = round_way(60, 0.03, 0.03);
  for (const std::size_t k : {28U, 29U, 31U, 32U, 58U, 59U})
    way.graph.add(surveyed_loop(way, 0, k));
  GraphEdge wrong = surveyed_loop(way, 0, 30);
  wrong.step.x += 5;
  way.graph.add(wrong);
  way.graph.solve();
  EXPECT_LT(worst_pose(way), 0.15);
  EXPECT_GT(way.graph.distance(wrong), 50);
}

TEST(PoseGraph, CovarianceGrowsWithTheWayAndShrinksWithALoop) {
  RoundWay way = round_way(60, 0, 0);
  const double near = way.graph.covariance(0, 10).trace();
  const double far = way.graph.covariance(0, 59).trace();
  EXPECT_GT(far, 4 * near);
  way.graph.add(surveyed_loop(way, 0, 59));
  EXPECT_LT(way.graph.covariance(0, 59).trace(), 0.01);
}

TEST(PoseGraph, RepeatsItselfBitForBit) {
  std::vector<Pose2> first;
  for (int run = 0; run < 2; ++run) {
    RoundWay way = round_way(40, 0.05, 0.05);
    way.graph.add(surveyed_loop(way, 0, 39));
    way.graph.solve();
    std::vector<Pose2> poses;
    for (std::size_t k = 0; k < way.graph.size(); ++k) poses.push_back(way.graph.pose(k));
    if (run == 0) first = poses;
    EXPECT_EQ(poses, first);
  }
}

}  // namespace
