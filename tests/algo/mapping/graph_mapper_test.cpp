// tests/algo/mapping/graph_mapper_test.cpp: a drive with drifting odometry.
#include "algo/mapping/graph_mapper.hpp"

#include <vector>

#include "tests/algo/mapping/rooms.hpp"
#include <gtest/gtest.h>

namespace {

using algo::GraphMapper;
using algo::LaserScan;
using algo::Pose2;

struct Laps {
  std::vector<Pose2> path_W{};
  std::vector<Pose2> odometry_W{};
  std::vector<LaserScan> scans{};
};

/// Two laps, with odometry 3 % too long and turns 8 % too large.
Laps two_laps() {
  Laps drive;
  drive.path_W = rooms::round_trip(40);
  for (const Pose2& pose_W : rooms::round_trip(40)) drive.path_W.push_back(pose_W);
  Pose2 odometry_W = drive.path_W.front();
  for (std::size_t i = 0; i < drive.path_W.size(); ++i) {
    if (i > 0) {
      const Pose2 step = algo::pose_step(drive.path_W[i - 1], drive.path_W[i]);
      odometry_W = algo::compose(odometry_W, {1.03 * step.x, 1.03 * step.y, 1.08 * step.heading});
    }
    drive.odometry_W.push_back(odometry_W);
    drive.scans.push_back(rooms::scan_at(drive.path_W[i]));
  }
  return drive;
}

std::vector<Pose2> laps_mapped(const Laps& drive) {
  GraphMapper mapper({});
  for (std::size_t i = 0; i < drive.scans.size(); ++i) {
    mapper.add(drive.scans[i], drive.odometry_W[i]);
  }
  return mapper.finish(drive.scans);
}

double drift(const Pose2& a, const Pose2& b) {
  return (a.position() - b.position()).norm();
}

TEST(PoseStep, IsTheInverseOfCompose) {
  const Pose2 from{1, -2, 2.5};
  const Pose2 step{0.3, 0.1, 1.2};
  const Pose2 back = algo::pose_step(from, algo::compose(from, step));
  EXPECT_NEAR(back.x, step.x, 1e-12);
  EXPECT_NEAR(back.y, step.y, 1e-12);
  EXPECT_NEAR(back.heading, step.heading, 1e-12);
}

TEST(GraphMapper, FindsThePathThatTheOdometryLost) {
  const Laps drive = two_laps();
  EXPECT_GT(drift(drive.odometry_W.back(), drive.path_W.back()), 0.5);
  const std::vector<Pose2> path_W = laps_mapped(drive);
  ASSERT_EQ(path_W.size(), drive.path_W.size());
  for (std::size_t i = 0; i < path_W.size(); ++i) {
    EXPECT_LT(drift(path_W[i], drive.path_W[i]), 0.05) << i;
  }
  EXPECT_EQ(laps_mapped(drive), path_W);
}

TEST(GraphMapper, TheFirstPoseIsTheOdometrys) {
  GraphMapper mapper({});
  const Pose2 here{3, 0.2, 0.4};
  const std::vector<LaserScan> scans{rooms::scan_at(here)};
  EXPECT_EQ(mapper.add(scans[0], here), here);
  EXPECT_EQ(mapper.finish(scans), std::vector{here});
}

TEST(GraphMapper, ScansWithoutReturnsFollowTheOdometry) {
  GraphMapper mapper({});
  LaserScan nothing;
  nothing.range_max = 20;
  nothing.angle_increment = 0.01;
  nothing.resize(100);
  for (std::size_t i = 0; i < nothing.size(); ++i) nothing.set_free(i);
  const std::vector<LaserScan> scans(80, nothing);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    mapper.add(scans[i], {0.3 * static_cast<double>(i), 0, 0});
  }
  EXPECT_NEAR(mapper.finish(scans).back().x, 0.3 * 79, 1e-6);
}

}  // namespace
