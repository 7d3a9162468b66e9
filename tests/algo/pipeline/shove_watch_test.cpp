// tests/algo/pipeline/shove_watch_test.cpp: shoves that the odometry does not tell of.
#include "algo/pipeline/shove_watch.hpp"

#include <random>

#include "tests/algo/allocations.hpp"
#include "tests/algo/worlds.hpp"
#include <gtest/gtest.h>

#include "algo/diff_drive.hpp"
#include "algo/full_strip/scan_points.hpp"

namespace {

using algo::Pose2;
using algo::Twist2;

constexpr double kPeriod = 0.025;  // [s]

worlds::World a_room() {
  worlds::World room;
  for (const auto& [low, high] : {std::pair{algo::Vec2(-4, -3), algo::Vec2(-3.8, 3)},
                                  std::pair{algo::Vec2(4, -3), algo::Vec2(4.2, 3)},
                                  std::pair{algo::Vec2(-4, 3), algo::Vec2(4, 3.2)},
                                  std::pair{algo::Vec2(-4, -3.2), algo::Vec2(4, -3)},
                                  std::pair{algo::Vec2(1.5, 0.8), algo::Vec2(2.1, 1.3)}}) {
    room.polygons.push_back(
        {low, algo::Vec2(high.x(), low.y()), high, algo::Vec2(low.x(), high.y())});
  }
  return room;
}

/// A scanner that sweeps the room from its true pose, on a robot that believes its odometry.
struct Shoved {
  explicit Shoved(double noise = 0.01) : noise_(noise) {}

  /// One period; the true pose moves by `push` besides the twist. True while a shove is noticed.
  bool tick(const Twist2& twist, const Twist2& push = {}) {
    stamp += kPeriod;
    odometry = algo::integrate_arc(odometry, twist, kPeriod);
    truth = algo::integrate_arc(truth, {twist.v + push.v, twist.omega + push.omega}, kPeriod);
    points.follow(odometry, stamp);
    scan.stamp = stamp;
    worlds::scan_world(truth, world, 8, scan);
    for (std::size_t i = 0; i < scan.size(); ++i) {
      if (scan.status[i] == algo::Beam::Ok) scan.ranges[i] += noise_of(random);
    }
    const Pose2 sensor_W = points.map(scan);
    return watch.take(scan, sensor_W, points.points_W());
  }
  bool ever(double seconds, const Twist2& twist, const Twist2& push = {}) {
    bool noticed = false;
    for (int k = 0; k < seconds / kPeriod; ++k) noticed = tick(twist, push) || noticed;
    return noticed;
  }

  worlds::World world = a_room();
  double stamp = 0;
  Pose2 odometry{}, truth{};
  algo::LaserScan scan{};
  algo::ScanPoints points{};
  algo::ShoveWatch watch{};

 private:
  double noise_;
  std::mt19937 random{7};
  std::normal_distribution<double> noise_of{0, noise_};
};

TEST(ShoveWatch, DrivingIsNoShove) {
  for (const Twist2& twist : {Twist2{0, 0},
                              Twist2{0.5, 0},
                              Twist2{-0.1, 0},
                              Twist2{0, 2.5},
                              Twist2{0.5, 0.4},
                              Twist2{2, -1}}) {
    Shoved robot;
    EXPECT_FALSE(robot.ever(1.5, twist)) << twist.v << " " << twist.omega;
  }
}

TEST(ShoveWatch, NoticesATurnThatTheWheelsDidNotMake) {
  for (const double way : {-1.0, 1.0}) {
    Shoved robot;
    robot.ever(1, {0.3, 0});
    EXPECT_TRUE(robot.ever(0.5, {0.3, 0}, {0, way})) << way;
    // It goes on while it is turned, and ends soon after.
    EXPECT_TRUE(robot.ever(0.5, {0, 0}, {0, way})) << way;
    robot.ever(0.5, {0, 0});
    EXPECT_FALSE(robot.ever(1, {0.3, 0})) << way;
  }
}

TEST(ShoveWatch, NoticesARobotThatWasCarriedAway) {
  Shoved robot;
  robot.ever(1, {0, 0});
  EXPECT_TRUE(robot.ever(1, {0, 0}, {0.8, 1.5}));
}

TEST(ShoveWatch, APersonInViewIsNoShove) {
  Shoved robot;
  for (double y = -2; y < 2; y += 1.3 * kPeriod) {
    robot.world.circles = {{{1.0, y}, 0.3}};
    EXPECT_FALSE(robot.tick({0, 0})) << y;
  }
}

TEST(ShoveWatch, NothingInViewIsNoShove) {
  Shoved robot;
  robot.world = {};
  EXPECT_FALSE(robot.ever(1, {0.5, 0}, {0, 1}));
}

TEST(ShoveWatch, ASteadyTickAllocatesNothing) {
  Shoved robot;
  robot.ever(1, {0.3, 0});
  const auto before = allocations::count();
  robot.ever(1, {0.3, 0});
  EXPECT_EQ(allocations::count(), before);
}

}  // namespace
