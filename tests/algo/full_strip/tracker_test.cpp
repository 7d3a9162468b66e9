// tests/algo/full_strip/tracker_test.cpp: moving bodies, possible ones, and those in the map.
#include "algo/full_strip/tracker.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "tests/algo/worlds.hpp"
#include <gtest/gtest.h>

namespace {

using algo::Track;
using algo::Vec2;

constexpr double kPeriod = 0.05;   // [s]
constexpr double kInfrared = 2.0;  // [m]

/// A scanner, at first at the origin, in a changing `world`.
struct Watch {
  worlds::World world{};
  worlds::World low{};  // things below the scanner's plane, which infrared sees within kInfrared
  algo::Pose2 sensor_W{};
  algo::Tracker tracker{};
  algo::LaserScan scan{};
  std::vector<Vec2> points_W{};
  double stamp = 0;

  void tick() {
    worlds::scan_world(sensor_W, world, 8, scan);
    enter_low();
    points_W.resize(scan.size());
    for (std::size_t i = 0; i < scan.size(); ++i) {
      points_W[i] =
          sensor_W.position() + scan.ranges[i] * algo::direction(sensor_W.heading + scan.angle(i));
    }
    scan.stamp = stamp;
    tracker.update(scan, sensor_W, points_W);
    stamp += kPeriod;
  }
  void enter_low() {
    for (std::size_t i = 0; i < scan.size(); ++i) {
      const Vec2 e = algo::direction(sensor_W.heading + scan.angle(i));
      const double range = worlds::cast(sensor_W.position(), e, low);
      if (range < std::min(kInfrared, scan.ranges[i])) scan.set_from_other_sensor(i, range);
    }
  }
  void run(double seconds, const std::function<void(double)>& move) {
    const double end = stamp + seconds;
    while (stamp < end) {
      move(stamp);
      tick();
    }
  }
  const Track* near(const Vec2& p_W) const {
    const auto found = std::ranges::find_if(tracker.moving(), [&](const Track& track) {
      return (track.position_W - p_W).norm() < 0.15;
    });
    return found == tracker.moving().end() ? nullptr : &*found;
  }
  std::size_t beams_taken() const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < scan.size(); ++i) count += tracker.on_moving(i) ? 1U : 0U;
    return count;
  }
};

TEST(Tracker, FollowsAPersonCrossing) {
  Watch watch;
  watch.world.circles.push_back({{3, -1}, 0.3});
  watch.run(1.0, [&](double t) { watch.world.circles[0].centre = {3, -1 + 1.2 * t}; });
  const Track* track = watch.near(watch.world.circles[0].centre);
  ASSERT_NE(track, nullptr);
  EXPECT_NEAR(track->velocity_W.x(), 0, 0.1);
  EXPECT_NEAR(track->velocity_W.y(), 1.2, 0.1);
  EXPECT_NEAR(track->radius, 0.3, 0.05);
}

TEST(Tracker, ABodyIsKeptOutOfTheMapFromTheFirstScan) {
  Watch watch;
  watch.world.circles.push_back({{3, 0}, 0.5});
  watch.tick();
  ASSERT_NE(watch.near({3, 0}), nullptr);
  EXPECT_GT(watch.beams_taken(), 20U);
}

TEST(Tracker, ABodyThatStandsBelongsToTheMap) {
  Watch watch;
  watch.world.circles.push_back({{3, 0}, 0.5});
  watch.run(2.0, [](double) {});
  EXPECT_TRUE(watch.tracker.moving().empty());
  EXPECT_EQ(watch.beams_taken(), 0U);
  // Until it leaves.
  watch.run(1.5, [&](double t) { watch.world.circles[0].centre = {3, 0.8 * (t - 2)}; });
  EXPECT_NE(watch.near(watch.world.circles[0].centre), nullptr);
}

TEST(Tracker, SomebodyWhoStandsMayBeginToWalk) {
  Watch watch;
  watch.world.circles = {{{3, 0}, 0.25}, {{2, 1}, 0.075}};
  watch.run(2.0, [](double) {});
  ASSERT_EQ(watch.tracker.standing().size(), 1U);  // the post is nobody
  EXPECT_NEAR(watch.tracker.standing()[0].position_W.x(), 3, 0.05);
  EXPECT_NEAR(watch.tracker.standing()[0].radius, 0.25, 0.05);
}

/// The beams of the rear scanner lie at other angles than those of the front one.
TEST(Tracker, ScannersWithOtherBeamsKeepTheirOwnMemories) {
  worlds::World world;
  world.circles.push_back({{2, 0.6}, 0.15});  // too thin to count as a body at once
  world.polygons.push_back({{-2, -3}, {-2, 3}, {-2.2, 3}, {-2.2, -3}});
  const algo::Pose2 back{0, 0, std::numbers::pi};
  algo::Tracker tracker;
  for (int k = 0; k < 40; ++k) {
    const bool rear = k % 2 == 1;
    const algo::Pose2 sensor_W = rear ? back : algo::Pose2{};
    algo::LaserScan scan;
    worlds::scan_world(sensor_W, world, 8, scan);
    if (rear) {
      algo::LaserScan narrow;
      narrow.resize(91);
      narrow.angle_min = scan.angle(135);
      narrow.angle_increment = scan.angle_increment;
      narrow.range_max = scan.range_max;
      for (std::size_t i = 0; i < narrow.size(); ++i) {
        if (scan.status[i + 135] == algo::Beam::Ok) narrow.set_ok(i, scan.ranges[i + 135]);
      }
      scan = narrow;
      scan.mount_R = back;
    }
    scan.stamp = k * kPeriod;
    std::vector<Vec2> points_W(scan.size());
    for (std::size_t i = 0; i < scan.size(); ++i) {
      points_W[i] = scan.ranges[i] * algo::direction(scan.angle(i) + sensor_W.heading);
    }
    tracker.update(scan, sensor_W, points_W);
  }
  EXPECT_TRUE(tracker.looks_back());
  EXPECT_TRUE(tracker.moving().empty());  // nothing moves
}

TEST(Tracker, PostsAndWallsBelongToTheMapAtOnce) {
  Watch watch;
  watch.world.circles.push_back({{2, 1}, 0.075});
  watch.world.polygons.push_back({{3, -0.6}, {3.2, -0.6}, {3.2, 0.4}, {3, 0.4}});
  watch.run(1.0, [](double) {});
  EXPECT_TRUE(watch.tracker.moving().empty());
  EXPECT_EQ(watch.beams_taken(), 0U);
}

/// Two or three posts that touch are one cluster, whose centre slides as the robot passes them.
TEST(Tracker, APassedThicketDoesNotMove) {
  std::mt19937 random(1);
  const auto uniform = [&](double from, double to) {
    return from + (to - from) * static_cast<double>(random()) / 4294967296.0;
  };
  for (int thicket = 0; thicket < 20; ++thicket) {
    Watch watch;
    for (int k = 0; k < 50; ++k) {
      const double side = uniform(0.5, 2.0);
      watch.world.circles.push_back({{uniform(0, 6), k % 2 == 0 ? side : -side}, 0.075});
    }
    int moving = 0;
    watch.run(4.0, [&](double t) {
      watch.sensor_W = {1.2 * t, 0.1 * std::sin(3 * t), 0.3 * std::cos(3 * t)};
      moving += std::ranges::count(watch.tracker.moving(), true, &Track::moves) > 0 ? 1 : 0;
    });
    EXPECT_EQ(moving, 0) << "ticks, in thicket " << thicket;
  }
}

/// The scanner looks over a low thing: it appears where infrared begins to see it.
TEST(Tracker, WhatTheScannerLooksOverBelongsToTheMap) {
  Watch watch;
  watch.low.circles = {{{3, 0.2}, 0.3}, {{3.5, -0.8}, 0.15}};
  watch.world.circles.push_back({{6, 0.5}, 0.1});
  std::size_t tracked = 0;
  watch.run(3.0, [&](double t) {
    watch.sensor_W = {0.8 * t, 0, 0.2 * std::sin(2 * t)};
    tracked += watch.tracker.moving().size();
  });
  EXPECT_EQ(tracked, 0U);
}

/// The corner of a box or a jamb, seen from its side, fits a circle within the noise of a scan.
TEST(Tracker, CornersBelongToTheMapAtOnce) {
  for (const double side : {0.2, 0.25, 0.3, 0.35, 0.4}) {
    for (double far = 1.0; far < 3.2; far += 0.5) {
      Watch watch;
      const Vec2 corner(far, 0);
      watch.world.polygons.push_back({corner,
                                      corner + side * algo::direction(0.785),
                                      corner + side * Vec2(std::sqrt(2), 0),
                                      corner + side * algo::direction(-0.785)});
      watch.tick();
      EXPECT_TRUE(watch.tracker.moving().empty()) << side << " m wide, " << far << " m away";
    }
  }
}

TEST(Tracker, ASlimPersonIsABodyFromTheFirstScan) {
  for (double far = 1.0; far < 4.2; far += 0.5) {
    Watch watch;
    watch.world.circles.push_back({{far, 0.3}, 0.25});
    watch.tick();
    EXPECT_NE(watch.near({far, 0.3}), nullptr) << far << " m away";
  }
}

TEST(Tracker, TwoPassingBodiesKeepTheirTracks) {
  Watch watch;
  watch.world.circles = {{{3, -2}, 0.4}, {{4, 2}, 0.4}};
  watch.run(4.0, [&](double t) {
    watch.world.circles[0].centre = {3, -2 + t};
    watch.world.circles[1].centre = {4, 2 - t};
  });
  const Track* first = watch.near(watch.world.circles[0].centre);
  const Track* second = watch.near(watch.world.circles[1].centre);
  ASSERT_NE(first, nullptr);
  ASSERT_NE(second, nullptr);
  EXPECT_NEAR(first->velocity_W.y(), 1, 0.15);
  EXPECT_NEAR(second->velocity_W.y(), -1, 0.15);
}

TEST(Tracker, BodiesSideBySideAreTwoTracks) {
  Watch watch;
  watch.world.circles = {{{3, 0.45}, 0.5}, {{3, -0.45}, 0.5}};  // they overlap
  watch.tick();
  EXPECT_NE(watch.near({3, 0.45}), nullptr);
  EXPECT_NE(watch.near({3, -0.45}), nullptr);
}

/// An LMS200 fires its beams one by one, and a sweep is up to a tick old when it is read. Its
/// tracks must still have the right speed, and the walker's position at the time of the query.
TEST(Tracker, ASweepingScanGivesTheSpeedOfAFlatOne) {
  constexpr double kTick = 0.026;
  constexpr double kSpeed = 1.2;
  const auto walker_at = [](double t) { return Vec2(3, -2 + kSpeed * t); };
  algo::Tracker tracker;
  algo::LaserScan scan;
  std::vector<Vec2> points_W;
  double stamp = 0;  // of the next sweep's end
  double now = 0;
  for (; now < 2.5; now += kTick) {
    const bool fresh = stamp <= now;
    if (fresh) {
      worlds::scan_world({}, {}, 8, scan);
      scan.stamp = stamp;
      scan.turn_period = 1.0 / 75;
      scan.turns = 2;
      points_W.resize(scan.size());
      for (std::size_t i = 0; i < scan.size(); ++i) {
        const worlds::World world{{{walker_at(scan.beam_time(i)), 0.3}}, {}};
        const double range = worlds::cast({0, 0}, algo::direction(scan.angle(i)), world);
        if (range < 8) scan.set_ok(i, range);
        points_W[i] = scan.ranges[i] * algo::direction(scan.angle(i));
      }
      tracker.update(scan, {}, points_W);
      stamp += scan.sweep_time();
    }
    tracker.predict(now);
  }
  now -= kTick;
  ASSERT_EQ(tracker.moving().size(), 1U);
  const Track& track = tracker.moving()[0];
  EXPECT_NEAR(track.velocity_W.y(), kSpeed, 0.1);
  EXPECT_NEAR(track.velocity_W.x(), 0, 0.1);
  EXPECT_NEAR(track.position_W.y(), walker_at(now).y(), 0.06);
}

TEST(Tracker, VanishedBodiesAreDropped) {
  Watch watch;
  watch.world.circles.push_back({{3, 0}, 0.5});
  watch.run(0.5, [&](double t) { watch.world.circles[0].centre = {3, t}; });
  watch.world.circles.clear();
  watch.run(0.3, [](double) {});
  EXPECT_TRUE(watch.tracker.moving().empty());
}

}  // namespace
