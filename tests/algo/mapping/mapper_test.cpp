// tests/algo/mapping/mapper_test.cpp: a drive with drifting odometry, mapped with and without
// matching.
#include "algo/mapping/mapper.hpp"

#include "tests/algo/mapping/rooms.hpp"
#include <gtest/gtest.h>

namespace {

using algo::Mapper;
using algo::MapperSettings;
using algo::Pose2;

/// [m] Final pose error of a drive of two laps, with odometry 3 % too long and turns 8 % too large.
double end_error(bool match) {
  MapperSettings settings;
  settings.match = match;
  Mapper mapper(settings, 800, {4, 1});
  std::vector<Pose2> path_W = rooms::round_trip(60);
  for (const Pose2& pose_W : rooms::round_trip(60)) path_W.push_back(pose_W);
  Pose2 odometry_W = path_W.front();
  Pose2 found_W{};
  for (std::size_t i = 0; i < path_W.size(); ++i) {
    if (i > 0) {
      Pose2 step = algo::pose_step(path_W[i - 1], path_W[i]);
      step = {1.03 * step.x, 1.03 * step.y, 1.08 * step.heading};
      odometry_W = algo::compose(odometry_W, step);
    }
    found_W = mapper.add(rooms::scan_at(path_W[i]), odometry_W);
  }
  return (found_W.position() - path_W.back().position()).norm();
}

TEST(PoseStep, IsTheInverseOfCompose) {
  const Pose2 from{1, -2, 2.5};
  const Pose2 step{0.3, 0.1, 1.2};
  const Pose2 back = algo::pose_step(from, algo::compose(from, step));
  EXPECT_NEAR(back.x, step.x, 1e-12);
  EXPECT_NEAR(back.y, step.y, 1e-12);
  EXPECT_NEAR(back.heading, step.heading, 1e-12);
}

TEST(Mapper, MatchingKeepsTheMapConsistent) {
  EXPECT_GT(end_error(false), 0.5);
  EXPECT_LT(end_error(true), 0.05);
}

TEST(Mapper, TheFirstScanIsPlacedByOdometry) {
  Mapper mapper({}, 800, {4, 1});
  const Pose2 here{3, 0.2, 0.4};
  EXPECT_EQ(mapper.add(rooms::scan_at(here), here), here);
  EXPECT_EQ(mapper.match().share, 1);
}

}  // namespace
