// tests/algo/mapping/loop_search_test.cpp: poses found by branch and bound.
#include "algo/mapping/loop_search.hpp"

#include <vector>

#include "tests/algo/mapping/rooms.hpp"
#include <gtest/gtest.h>

namespace {

using algo::LoopSearch;
using algo::Pose2;
using algo::Submap;
using algo::Vec2;

const Pose2 kSubmapFrom{3.0, 0.2, 0.4};

Submap submap_from(const Pose2& pose_W) {
  algo::OccupancyMap map(0.05);
  map.insert(rooms::scan_at(pose_W), {}, 20);
  return Submap(map);
}

TEST(LoopSearch, FindsAPoseMetresFromTheGuess) {
  const LoopSearch search(submap_from(kSubmapFrom));
  const Pose2 other_W{4.2, -0.3, 0.9};
  const Pose2 truth = algo::pose_step(kSubmapFrom, other_W);
  const std::vector<Vec2> points = submap_from(other_W).thinned(0.3).points;
  const auto found =
      search.best(points, {truth.x + 4, truth.y - 5, truth.heading + 0.3}, {6, 6, 0.4}, 0.4);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->pose.x, truth.x, 0.15);
  EXPECT_NEAR(found->pose.y, truth.y, 0.15);
  EXPECT_NEAR(found->pose.heading, truth.heading, 0.02);
  EXPECT_GT(found->score, 0.6);
}

TEST(LoopSearch, LeavesOutWhatIsKnownAndWhatScoresTooLittle) {
  const LoopSearch search(submap_from(kSubmapFrom));
  const std::vector<Vec2> points = submap_from(kSubmapFrom).thinned(0.3).points;
  const auto first = search.best(points, {}, {3, 3, 0.2}, 0.4);
  ASSERT_TRUE(first);
  EXPECT_NEAR(first->pose.position().norm(), 0, 0.1);
  const auto next = search.best(points, {}, {3, 3, 0.2}, 0.1, std::vector{*first}, 1);
  ASSERT_TRUE(next);
  EXPECT_GE((next->pose.position() - first->pose.position()).norm(), 1);
  EXPECT_LT(next->score, first->score);
  EXPECT_FALSE(search.best(points, {20, 0, 0}, {1, 1, 0.1}, 0.4));
  EXPECT_FALSE(search.best({}, {}, {1, 1, 0.1}, 0.4));
}

}  // namespace
