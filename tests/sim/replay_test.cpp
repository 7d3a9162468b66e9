// tests/sim/replay_test.cpp: replays a small log as a robot.
#include "sim/replay.hpp"

#include <chrono>
#include <memory>
#include <numbers>
#include <sstream>

#include <gtest/gtest.h>

namespace sim {
namespace {

constexpr double kTurnedMount = std::numbers::pi;

std::string scan(const std::string& readings,
                 const std::string& poses,
                 const std::string& stamp,
                 const std::string& name = "FLASER") {
  return name + " 4 " + readings + " " + poses + " " + stamp + " host 0\n";
}

std::unique_ptr<Replay> replay(const std::string& text) {
  std::istringstream log(text);
  auto result = std::make_unique<Replay>(log, "test.log");
  return result;
}

std::string failure(const std::string& text) {
  try {
    std::istringstream log(text);
    const Replay result(log, "test.log");
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(Replay, OneScanATickWithPosesTwistsAndStamps) {
  const auto robot = replay("# comment\n" + scan("1 2 3 81.91", "1 2 0 1 2 0", "100.0") +
                            "ODOM 1 2 0 0 0 0 100 host 0\n" +
                            scan("1.5 2 3 81.83", "1.5 2 0.2 1.5 2 0.2", "100.5"));
  algo::Observation seen;
  robot->reset(seen);
  EXPECT_EQ(seen.stamp, 0);
  EXPECT_EQ(seen.odometry.pose, (algo::Pose2{1, 2, 0}));
  EXPECT_EQ(seen.odometry.twist, algo::Twist2{});
  ASSERT_EQ(seen.scans.size(), 1u);
  EXPECT_EQ(seen.scans[0].ranges[1], 2.0);
  EXPECT_EQ(seen.scans[0].range_max, 81.91);
  EXPECT_EQ(seen.scans[0].status[3], algo::Beam::Invalid);
  EXPECT_EQ(seen.scans[0].codes[3], algo::BeamCode::NoEcho);
  EXPECT_EQ(seen.scans[0].mount_R, algo::Pose2{});

  ASSERT_TRUE(robot->step({}, seen));
  EXPECT_EQ(seen.stamp, 0.5);
  EXPECT_EQ(seen.scans[0].stamp, 0.5);
  EXPECT_EQ(seen.scans[0].status[3], algo::Beam::Free);
  // 0.5 m along x in 0.5 s, seen at the middle heading of 0.1: 1 m/s * cos(0.1); turned 0.2 rad.
  EXPECT_NEAR(seen.odometry.twist.v, std::cos(0.1), 1e-9);
  EXPECT_NEAR(seen.odometry.twist.omega, 0.4, 1e-9);
  EXPECT_EQ(robot->next_period(), 0);
  EXPECT_FALSE(robot->step({}, seen));
  EXPECT_EQ(seen.stamp, 0.5);
  robot->reset(seen);
  EXPECT_EQ(seen.stamp, 0);
}

TEST(Replay, FixedPeriodWithoutUsableStamps) {
  const std::string poses = "0 0 0 0 0 0";
  const auto robot = replay(scan("1 1 1 1", poses, "5") + scan("1 1 1 1", poses, "5") +
                            scan("1 1 1 1", poses, "4") + scan("1 1 1 1", poses, "4.1") +
                            scan("1 1 1 1", poses, "90000"));
  algo::Observation seen;
  robot->reset(seen);
  std::vector<double> stamps;
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(robot->step({}, seen));
    stamps.push_back(seen.stamp);
  }
  EXPECT_NEAR(stamps[0], 0.2, 1e-9);  // repeated
  EXPECT_NEAR(stamps[1], 0.4, 1e-9);  // backwards
  EXPECT_NEAR(stamps[2], 0.5, 1e-9);
  EXPECT_NEAR(stamps[3], 0.7, 1e-9);  // a day later: a clock was set
}

TEST(Replay, StampsTooCloseForAnyScannerAreUnusable) {
  std::string log;
  for (int i = 0; i < 5; ++i)
    log += scan("1 2 3 4", "0 0 0 0 0 0", "100.000000" + std::to_string(i));
  const auto robot = replay(log);
  EXPECT_GT(robot->spec().period, 1e-3);  // it sizes buffers and must not be near zero
}

TEST(Replay, ReportsThePeriodOfTheNextScan) {
  const auto robot =
      replay(scan("1 1 1 1", "0 0 0 0 0 0", "1") + scan("1 1 1 1", "0 0 0 0 0 0", "1.05"));
  algo::Observation seen;
  robot->reset(seen);
  EXPECT_NEAR(robot->next_period(), 0.05, 1e-9);
  ASSERT_TRUE(robot->step({}, seen));
  EXPECT_EQ(robot->next_period(), 0);
}

TEST(Replay, MountsComeFromTheTwoPoses) {
  // Robot at (1, 2) looking along +y; its scanners 0.2 m ahead and 0.3 m behind.
  const std::string half_pi = "1.5707963267948966";
  const auto robot =
      replay(scan("1 1 1 1", "1 2.2 " + half_pi + " 1 2 " + half_pi, "1") +
             scan("1 1 1 1", "1 1.7 -" + half_pi + " 1 2 " + half_pi, "2", "RLASER"));
  algo::Observation seen;
  robot->reset(seen);
  EXPECT_NEAR(seen.scans[0].mount_R.x, 0.2, 1e-9);
  EXPECT_NEAR(seen.scans[0].mount_R.y, 0, 1e-9);
  EXPECT_NEAR(seen.scans[0].mount_R.heading, 0, 1e-9);
  ASSERT_TRUE(robot->step({}, seen));
  EXPECT_NEAR(seen.scans[0].mount_R.x, -0.3, 1e-9);
  EXPECT_NEAR(std::abs(seen.scans[0].mount_R.heading), kTurnedMount, 1e-9);
}

TEST(Replay, MillimetreLogsKeepTheirMillimetres) {
  const auto robot = replay(scan("3.382 4.001 32.767 32.763", "0 0 0 0 0 0", "1"));
  EXPECT_EQ(robot->unit(), CarmenUnit::Millimetre32m);
  algo::Observation seen;
  robot->reset(seen);
  EXPECT_EQ(seen.scans[0].ranges[0], 3.382);
  EXPECT_EQ(seen.scans[0].codes[2], algo::BeamCode::NoEcho);
  EXPECT_EQ(seen.scans[0].codes[3], algo::BeamCode::WeakSignal);
}

TEST(Replay, DamagedLinesAreSkippedAndCounted) {
  const auto robot = replay("ODOM nan 0 0 0 0 0 1 h 1\nFLASER 4 1 2\n" +
                            scan("1 2 3 4", "0 0 0 0 0 0", "1") + "FLASER 4 x\n");
  EXPECT_EQ(robot->size(), 1u);
  EXPECT_EQ(robot->damage(),
            "3 unreadable (line 1: a number of the odometry is missing or not finite)");
}

TEST(Replay, ReportsWhyALogCannotBeReplayed) {
  EXPECT_EQ(failure(""), "The log test.log is empty.");
  EXPECT_EQ(failure("PARAM a 1\nODOM 1 2 0.5 0.3 -0.1 0 7.5 host 0.2\nFLASER 4 1\n"),
            "The log test.log holds no scan (FLASER, RLASER or ROBOTLASER1): 3 lines, 1 of them "
            "odometry, 1 unreadable (line 3: reading 2 of 4 is missing or not a distance).");
  try {
    const Replay missing("/nonexistent/some.log");
    FAIL() << "opened a file that does not exist";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "The log some.log cannot be opened.");
  }
  EXPECT_THROW(Replay(std::filesystem::path("/tmp")), std::runtime_error);
}

TEST(Replay, CannotBeEdited) {
  const auto robot = replay(scan("1 2 3 4", "0 0 0 0 0 0", "1"));
  EXPECT_EQ(robot->editing(), nullptr);
  EXPECT_EQ(robot->arming(), nullptr);
  EXPECT_FALSE(robot->spec().drives);
}

}  // namespace
}  // namespace sim
