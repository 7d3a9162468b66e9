// tests/server/serve/operator_watch_test.cpp: counting watchers, and disarming a robot without one;
// the clock is an argument.
#include "server/serve/operator_watch.hpp"

#include <gtest/gtest.h>

namespace server {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

const OperatorWatch::Time kWatchStart{seconds(1000)};

TEST(OperatorWatchTest, AMovingRobotIsDisarmed1500MsAfterTheLastSign) {
  OperatorWatch watch;
  watch.page_sign(7, kWatchStart);
  EXPECT_STREQ(watch.why_disarm(1, true, kWatchStart + milliseconds(1500)), nullptr);
  EXPECT_STREQ(watch.why_disarm(1, true, kWatchStart + milliseconds(1501)), OperatorWatch::kGone);
  // WHEN another sign comes THEN the time restarts.
  watch.script_sign(kWatchStart + milliseconds(1600));
  EXPECT_STREQ(watch.why_disarm(1, true, kWatchStart + milliseconds(3000)), nullptr);
  EXPECT_STREQ(watch.why_disarm(1, true, kWatchStart + milliseconds(3200)), OperatorWatch::kGone);
}

TEST(OperatorWatchTest, WithoutAnySignThereIsNoOperator) {
  OperatorWatch watch;
  EXPECT_STREQ(watch.why_disarm(1, true, kWatchStart), OperatorWatch::kGone);
  EXPECT_STREQ(watch.why_disarm(1, false, kWatchStart), nullptr);
}

TEST(OperatorWatchTest, AnArmedRobotAtRestIsDisarmedAfterAMinute) {
  OperatorWatch watch;
  watch.script_sign(kWatchStart);
  // GIVEN a robot armed long after the last sign, as by --armed THEN the time starts at the arming.
  const auto armed = kWatchStart + seconds(500);
  EXPECT_STREQ(watch.why_disarm(0, false, armed - seconds(1)), nullptr);
  EXPECT_STREQ(watch.why_disarm(1, false, armed), nullptr);
  EXPECT_STREQ(watch.why_disarm(1, false, armed + seconds(60)), nullptr);
  EXPECT_STREQ(watch.why_disarm(1, false, armed + seconds(61)), OperatorWatch::kLeft);
  // WHEN a watcher is there THEN it stays armed.
  watch.page_sign(1, armed + seconds(61));
  EXPECT_STREQ(watch.why_disarm(1, false, armed + seconds(100)), nullptr);
}

TEST(OperatorWatchTest, DisarmedAndUnattendedRobotsAreNotDisarmed) {
  OperatorWatch watch;
  EXPECT_STREQ(watch.why_disarm(0, true, kWatchStart), nullptr);
  watch.need_nobody();
  EXPECT_STREQ(watch.why_disarm(1, true, kWatchStart), nullptr);
  EXPECT_STREQ(watch.why_disarm(1, false, kWatchStart + seconds(3600)), nullptr);
}

TEST(OperatorWatchTest, WatchersArePagesAndScriptsWithARecentSign) {
  OperatorWatch watch;
  EXPECT_EQ(watch.watchers(kWatchStart), (Watchers{0, false}));
  watch.page_sign(1, kWatchStart);
  watch.page_sign(2, kWatchStart);
  watch.page_sign(2, kWatchStart + seconds(1));
  watch.script_sign(kWatchStart);
  EXPECT_EQ(watch.watchers(kWatchStart + seconds(1)), (Watchers{2, true}));
  EXPECT_EQ(watch.watchers(kWatchStart + seconds(2)), (Watchers{1, false}));
  // WHEN a page is closed THEN it no longer counts as watcher, but its last sign still counts.
  watch.page_gone(2);
  EXPECT_EQ(watch.watchers(kWatchStart + seconds(2)), (Watchers{0, false}));
  EXPECT_STREQ(watch.why_disarm(1, true, kWatchStart + seconds(2)), nullptr);
}

TEST(OperatorWatchTest, AGoalACommandOrTurningWheelsMeanMoving) {
  algo::Telemetry t;
  EXPECT_FALSE(on_its_way(t));
  t.goal = algo::SetGoal{{1, 0}, {}};
  t.mission = algo::Mission::Held;
  EXPECT_TRUE(on_its_way(t));
  t.mission = algo::Mission::Arrived;
  EXPECT_FALSE(on_its_way(t));
  t.command.base = {0, 0.1};
  EXPECT_TRUE(on_its_way(t));
  t.command.base = {};
  t.observation.odometry.twist = {0.02, 0};
  EXPECT_TRUE(on_its_way(t));
}

}  // namespace
}  // namespace server
