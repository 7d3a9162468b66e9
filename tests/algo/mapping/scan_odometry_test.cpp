// tests/algo/mapping/scan_odometry_test.cpp: laps in a room on wheels that err.
#include "algo/mapping/scan_odometry.hpp"

#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "tests/algo/allocations.hpp"
#include "tests/algo/mapping/rooms.hpp"
#include <gtest/gtest.h>

namespace {

using algo::Pose2;
using algo::ScanOdometry;
using algo::Vec2;

std::vector<Vec2> points_at(const Pose2& pose_W, const worlds::World& world = rooms::room()) {
  const algo::LaserScan scan = rooms::scan_at(pose_W, world);
  std::vector<Vec2> points_R;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (scan.status[i] != algo::Beam::Ok) continue;
    points_R.push_back(scan.ranges[i] * algo::direction(scan.angle(i)));
  }
  return points_R;
}

/// Laps on wheels whose ways and turns read 3 % too long.
class Laps {
 public:
  explicit Laps(const worlds::World& world = rooms::room(),
                std::vector<Pose2> path_W = rooms::round_trip(160))
      : path_W_(std::move(path_W)), scans_(scans_of(path_W_, world)) {
    odometry_.reset(path_W_.front(), wheels_);
    believed_W_.reserve(kMostLaps * path_W_.size());
  }
  void drive() {
    for (std::size_t k = 1; k < path_W_.size(); ++k) {
      const Pose2 step = algo::pose_step(path_W_[k - 1], path_W_[k]);
      wheels_ = algo::compose(
          wheels_, {1.03 * step.x + shaken(), 1.03 * step.y, 1.03 * step.heading + shaken()});
      if (odometry_.take(scans_[k], {0, 0}, wheels_)) ++moves_;
      believed_W_.push_back(odometry_.pose_W(wheels_).position());
      const Vec2 off = odometry_.pose_W(wheels_).position() - path_W_[k].position();
      worst_ = std::max(worst_, off.norm());
    }
  }
  double worst() const { return worst_; }  // [m]
  int moves() const { return moves_; }     // of the map
  /// [m] From the end of the way to the place where it lay when the robot came there first.
  double newest_doubling() const {
    const Vec2 end_W = path_W_.back().position();
    for (std::size_t k = 1; k + 100 < path_W_.size(); ++k) {
      if ((path_W_[k].position() - end_W).norm() > 1e-6) continue;
      return (believed_W_[k - 1] - believed_W_.back()).norm();
    }
    return std::numeric_limits<double>::infinity();
  }
  double by_wheels() const {  // [m] off at the end, by the wheels alone
    const Pose2 way = algo::pose_step({7, 7, 1}, wheels_);
    return (algo::compose(path_W_.front(), way).position() - path_W_.back().position()).norm();
  }
  const ScanOdometry& odometry() const { return odometry_; }

 private:
  /// [m] or [rad] of noise.
  double shaken() {
    return kNoise *
           (2.0 * static_cast<double>(random_()) / static_cast<double>(std::minstd_rand::max()) -
            1);
  }
  static constexpr std::size_t kMostLaps = 4;
  static constexpr double kNoise = 0.02;
  static std::vector<std::vector<Vec2>> scans_of(const std::vector<Pose2>& path_W,
                                                 const worlds::World& world) {
    std::vector<std::vector<Vec2>> scans;
    scans.reserve(path_W.size());
    for (const Pose2& pose_W : path_W) scans.push_back(points_at(pose_W, world));
    return scans;
  }

  std::vector<Pose2> path_W_;
  std::vector<std::vector<Vec2>> scans_;
  std::minstd_rand random_{1};
  Pose2 wheels_{7, 7, 1};
  ScanOdometry odometry_{};
  double worst_ = 0;
  int moves_ = 0;
  std::vector<Vec2> believed_W_{};
};

TEST(ScanOdometry, StaysTrueOverLapsOnWheelsThatErrByThreePercent) {
  Laps laps;
  for (int lap = 0; lap < 3; ++lap) laps.drive();
  EXPECT_GT(laps.by_wheels(), 0.3);
  EXPECT_LT(laps.worst(), 0.1);
}

TEST(ScanOdometry, TakesThinWallsSeenFromBothSidesForTwoFaces) {
  Laps laps(rooms::room_in_hall(), rooms::round_and_in(10));
  laps.drive();
  EXPECT_GT(laps.by_wheels(), 0.3);
  EXPECT_LT(laps.worst(), 0.25);
}

TEST(ScanOdometry, ClosesALoopThatEndsFartherOffThanTheMatcherReaches) {
  Laps laps(rooms::ring(), rooms::around_ring());
  laps.drive();
  EXPECT_EQ(laps.moves(), 1);
  EXPECT_GT(laps.worst(), 1);  // before
  EXPECT_LT(laps.newest_doubling(), 0.1);
}

TEST(ScanOdometry, NeedsNoMoreMemoryForMoreLaps) {
  Laps laps;
  for (int lap = 0; lap < 3; ++lap) laps.drive();
  const std::size_t bytes = laps.odometry().map().bytes();
  const std::size_t stations = laps.odometry().stations();
  const std::size_t before = allocations::count();
  laps.drive();
  EXPECT_EQ(allocations::count(), before);
  EXPECT_EQ(laps.odometry().map().bytes(), bytes);
  EXPECT_EQ(laps.odometry().stations(), stations);
}

TEST(ScanOdometry, FollowsTheWheelsWhereAScanMeetsNoWall) {
  ScanOdometry odometry;
  odometry.reset({1, 2, 0}, {0, 0, 0});
  odometry.take(points_at({0, 0, 0}), {0, 0}, {0, 0, 0});
  odometry.take({}, {0, 0}, {0.5, 0, 0});
  EXPECT_NEAR(odometry.pose_W({0.5, 0, 0}).x, 1.5, 1e-9);
}

}  // namespace
