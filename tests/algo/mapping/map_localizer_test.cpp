// tests/algo/mapping/map_localizer_test.cpp: a robot that knows its map, is put elsewhere, or
// stands in one of two rooms that look alike.
#include "algo/mapping/map_localizer.hpp"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tests/algo/allocations.hpp"
#include "tests/algo/mapping/rooms.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

using algo::LaserScan;
using algo::MapFix;
using algo::MapLocalizer;
using algo::OccupancyMap;
using algo::Pose2;
using algo::Submap;
using algo::Vec2;

constexpr double kScannerReach = 20;  // [m]

/// Draws a scan as a map from a file has it: no wall knows from which side it was seen.
void draw(const LaserScan& scan, const Pose2& pose_M, OccupancyMap& map) {
  algo::FacedPoints seen_M;
  seen_M.take(scan, pose_M, kScannerReach);
  for (const Vec2& p_M : seen_M.points) map.insert(pose_M.position(), p_M);
}

/// The room, once at each of `corners_M`.
Submap rooms_at(const std::vector<Vec2>& corners_M) {
  OccupancyMap map(0.05);
  for (const Vec2& corner_M : corners_M) {
    for (const Pose2& pose : rooms::round_trip(30)) {
      const Pose2 pose_M{pose.x + corner_M.x(), pose.y + corner_M.y(), pose.heading};
      draw(rooms::scan_at(pose), pose_M, map);
    }
  }
  return Submap(map);
}

/// Lets the robot stand at `pose` of the room until the search is over and its places are matched.
void stand(MapLocalizer& localizer, const Pose2& pose, const Pose2& odometry_W) {
  const LaserScan scan = rooms::scan_at(pose);
  for (int k = 0; k < 3000; ++k) {
    localizer.take(scan, odometry_W);
    if (localizer.fix() != MapFix::Searching) return;
  }
}

double distance(const Pose2& a, const Pose2& b) {
  return (a.position() - b.position()).norm();
}

TEST(MapLocalizer, FollowsTheRobotOverOdometryThatIsOffBySixPercent) {
  MapLocalizer localizer(rooms_at({{0, 0}}));
  const std::vector<Pose2> path_M = rooms::round_trip(120);
  localizer.place({path_M[0].x + 1.2, path_M[0].y - 0.8, path_M[0].heading + 0.3});
  Pose2 odometry_W{7, 7, 1};
  stand(localizer, path_M[0], odometry_W);
  ASSERT_TRUE(localizer.located()) << localizer.sentence();
  for (int lap = 0; lap < 3; ++lap) {
    for (std::size_t k = 1; k < path_M.size(); ++k) {
      const Pose2 step = algo::pose_step(path_M[k - 1], path_M[k]);
      odometry_W = algo::compose(odometry_W, {1.06 * step.x, 1.06 * step.y, 1.06 * step.heading});
      localizer.take(rooms::scan_at(path_M[k]), odometry_W);
      ASSERT_TRUE(localizer.located()) << localizer.sentence();
      const Pose2 off = algo::pose_step(localizer.best().pose_M(), path_M[k]);
      EXPECT_LT(off.position().norm(), 0.06) << lap << " " << k;
      const Eigen::Matrix3d c = localizer.best().covariance();
      const double deviation = std::sqrt(c(0, 0) + c(1, 1));
      EXPECT_LT(off.position().norm(), 4 * deviation);
      EXPECT_LT(deviation, 0.1);
    }
  }
  EXPECT_NEAR(localizer.best().scale().distance, 1 / 1.06 - 1, 0.01);
  EXPECT_NEAR(localizer.best().scale().turn, 1 / 1.06 - 1, 0.01);
}

/// Ten steps of 0.1 m forwards, of which the odometry tells the opposite.
TEST(MapLocalizer, FollowsTheScansWhereTheOdometryTellsTheOppositeWay) {
  MapLocalizer localizer(rooms_at({{0, 0}}));
  const std::vector<Pose2> path_M = rooms::round_trip(300);
  Pose2 odometry_W{};
  localizer.start(path_M[0]);
  for (std::size_t k = 1; k < path_M.size(); ++k) {
    Pose2 step = algo::pose_step(path_M[k - 1], path_M[k]);
    if (k >= 60 && k < 70) step = {-step.x, -step.y, step.heading};
    odometry_W = algo::compose(odometry_W, step);
    localizer.take(rooms::scan_at(path_M[k]), odometry_W);
    EXPECT_TRUE(localizer.located()) << k << " " << localizer.sentence();
    const double most = k >= 60 && k < 80 ? 0.3 : 0.06;
    EXPECT_LT(distance(localizer.best().pose_M(), path_M[k]), most) << k;
  }
}

/// The wheels see nothing of the way of a robot that is pushed, beyond the matcher's reach.
TEST(MapLocalizer, LooksAboutThePlaceWhereTheScansCeaseToFit) {
  MapLocalizer localizer(rooms_at({{0, 0}, {30, 0}}));
  const std::vector<Pose2> path_M = rooms::round_trip(300);
  constexpr std::size_t kPush = 10;
  constexpr std::size_t kPushed = 25;
  Pose2 odometry_W{};
  localizer.start(path_M[0]);
  int lost = 0;
  for (std::size_t k = 1; k < path_M.size(); ++k) {
    const bool pushed = k > kPush && k <= kPush + kPushed;
    if (pushed) continue;
    odometry_W = algo::compose(odometry_W, algo::pose_step(path_M[k - 1], path_M[k]));
    localizer.take(rooms::scan_at(path_M[k]), odometry_W);
    if (!localizer.located()) ++lost;
  }
  EXPECT_GT(lost, 0);
  EXPECT_LT(lost, 30);
  // Two rooms look alike: a search everywhere could not tell in which one the robot is.
  ASSERT_TRUE(localizer.located()) << localizer.sentence();
  EXPECT_LT(distance(localizer.best().pose_M(), path_M.back()), 0.06);
}

/// A corridor of 40 m without anything in it, and its scans as far as 8 m.
LaserScan corridor_scan(const Pose2& pose) {
  worlds::World corridor;
  corridor.polygons = {{{0, -1.3}, {40, -1.3}, {40, 1.3}, {0, 1.3}}};
  LaserScan scan;
  worlds::scan_world(pose, corridor, 8.0, scan);
  return scan;
}

TEST(MapLocalizer, AlongAPlainCorridorAGivenPoseStaysUnsureAndAStartIsBelieved) {
  OccupancyMap map(0.05);
  for (double x = 0; x <= 40; x += 0.025) {
    for (const double y : {-1.3, 1.3}) map.mark_wall({x, y});
  }
  for (double y = -1.3; y <= 1.3; y += 0.025) {
    for (const double x : {0.0, 40.0}) map.mark_wall({x, y});
  }
  MapLocalizer localizer{Submap(map)};
  const Pose2 truth{20, 0.3, 0};
  const LaserScan scan = corridor_scan(truth);
  const auto wait = [&] {
    for (int k = 0; k < 3000; ++k) {
      localizer.take(scan, {});
      if (localizer.fix() != MapFix::Searching) return;
    }
  };
  localizer.place({20.8, 0.1, 0.2});
  wait();
  EXPECT_EQ(localizer.fix(), MapFix::Unsure) << localizer.sentence();
  ASSERT_EQ(localizer.places(), 1U);
  const Eigen::Matrix3d c = localizer.best().covariance();
  EXPECT_GT(std::sqrt(c(0, 0)), 0.5);
  EXPECT_LT(std::sqrt(c(1, 1)), 0.1);
  localizer.start(truth);
  wait();
  EXPECT_TRUE(localizer.located()) << localizer.sentence();
  EXPECT_LT(distance(localizer.best().pose_M(), truth), 0.1);
  // Anywhere along it looks alike.
  localizer.forget();
  wait();
  EXPECT_EQ(localizer.fix(), MapFix::NotUnique) << localizer.sentence();
}

TEST(MapLocalizer, ARobotThatWasPutElsewhereIsNotBelievedUntilItsPlaceIsFound) {
  MapLocalizer localizer(rooms_at({{0, 0}}));
  const Pose2 truth{7, -0.4, 2.2};
  localizer.place({1, 0.2, -0.5});
  const LaserScan scan = rooms::scan_at(truth);
  int calls = 0;
  while (localizer.fix() == MapFix::Searching && calls < 3000) {
    localizer.take(scan, {});
    EXPECT_FALSE(localizer.located() && distance(localizer.best().pose_M(), truth) > 0.1);
    ++calls;
  }
  ASSERT_TRUE(localizer.located()) << localizer.sentence();
  EXPECT_LT(distance(localizer.best().pose_M(), truth), 0.05);
  EXPECT_THAT(localizer.sentence(), testing::StartsWith("Located within"));
}

TEST(MapLocalizer, BetweenTwoRoomsThatLookAlikeItBelievesNone) {
  MapLocalizer localizer(rooms_at({{0, 0}, {30, 6}}));
  const Pose2 truth{3, 0.2, 0.4};
  stand(localizer, truth, {});
  EXPECT_EQ(localizer.fix(), MapFix::NotUnique);
  EXPECT_FALSE(localizer.located());
  EXPECT_EQ(localizer.sentence(), "Not located: 2 places look alike.");
  // A pose that somebody gives decides.
  localizer.place({33.5, 6, 0.2});
  stand(localizer, truth, {});
  ASSERT_TRUE(localizer.located()) << localizer.sentence();
  EXPECT_LT(distance(localizer.best().pose_M(), {33, 6.2, 0.4}), 0.05);
}

TEST(MapLocalizer, AScanOfAnotherPlaceFitsNowhere) {
  MapLocalizer localizer(rooms_at({{0, 0}}));
  worlds::World pen;
  pen.polygons = {{{-6, -4}, {6, -4}, {0, 9}}};
  LaserScan scan;
  worlds::scan_world({0, 0, 0}, pen, kScannerReach, scan);
  for (int k = 0; k < 3000 && localizer.fix() == MapFix::Searching; ++k) localizer.take(scan, {});
  EXPECT_EQ(localizer.fix(), MapFix::Nowhere);
  EXPECT_THAT(localizer.sentence(), testing::HasSubstr("fits nowhere"));
}

TEST(MapLocalizer, ARobotCarriedAwayIsSearchedAnew) {
  MapLocalizer localizer(rooms_at({{0, 0}}));
  localizer.place({3, 0.2, 0.4});
  stand(localizer, {3, 0.2, 0.4}, {});
  ASSERT_TRUE(localizer.located());
  localizer.take(rooms::scan_at({7, -0.4, 2.2}), {50, 0, 0});
  EXPECT_FALSE(localizer.located());
  stand(localizer, {7, -0.4, 2.2}, {50, 0, 0});
  ASSERT_TRUE(localizer.located()) << localizer.sentence();
  EXPECT_LT(distance(localizer.best().pose_M(), {7, -0.4, 2.2}), 0.05);
}

TEST(MapLocalizer, ARobotCarriedWhileItStandsIsSoonNotBelievedAndThenFound) {
  MapLocalizer localizer(rooms_at({{0, 0}}));
  localizer.place({3, 0.2, 0.4});
  stand(localizer, {3, 0.2, 0.4}, {});
  ASSERT_TRUE(localizer.located());
  const Pose2 truth{7, -0.4, 2.2};
  const LaserScan scan = rooms::scan_at(truth);
  int believed = 0;
  for (int k = 0; k < 3000; ++k) {
    localizer.take(scan, {});
    if (!localizer.located()) continue;
    if (distance(localizer.best().pose_M(), truth) < 0.05) break;
    ++believed;
  }
  EXPECT_LE(believed, 40);
  EXPECT_LT(distance(localizer.best().pose_M(), truth), 0.05);
  EXPECT_TRUE(localizer.located()) << localizer.sentence();
}

TEST(MapLocalizer, SearchesAndFollowsWithoutAllocating) {
  MapLocalizer localizer(rooms_at({{0, 0}}));
  const std::vector<Pose2> path_M = rooms::round_trip(120);
  std::vector<LaserScan> scans;
  for (const Pose2& pose_M : path_M) scans.push_back(rooms::scan_at(pose_M));
  localizer.take(scans[0], path_M[0]);
  localizer.forget();
  const std::size_t before = allocations::count();
  for (int k = 0; k < 3000 && localizer.fix() == MapFix::Searching; ++k) {
    localizer.take(scans[0], path_M[0]);
  }
  for (std::size_t k = 0; k < 30; ++k) localizer.take(scans[k], path_M[k]);
  EXPECT_EQ(allocations::count(), before);
  EXPECT_TRUE(localizer.located());
}

}  // namespace
