// tests/algo/pipeline/sequencing_test.cpp: idle, driving, arrived, stuck; and the stuck rule's
// window.
#include "algo/pipeline/sequencing.hpp"

#include <gtest/gtest.h>

namespace algo {
namespace {

constexpr double kPeriod = 0.05;

TEST(StuckDetector, WindowIsTwentySecondsOrEightHundredMillimetresOfTravel) {
  EXPECT_DOUBLE_EQ(StuckDetector::window(0.1), 20.0);   // 0.8 / 0.1 = 8 s, so 20
  EXPECT_DOUBLE_EQ(StuckDetector::window(0.02), 40.0);  // 0.8 / 0.02
}

TEST(StuckDetector, ReportsStuckOnceTheWholeWindowIsWithinSixtyMillimetres) {
  StuckDetector detector;
  detector.reset(kPeriod);
  // 20 s of 0.05 s = 400 earlier positions; the 401st call is the first that may report stuck.
  for (int i = 0; i < 400; ++i) ASSERT_FALSE(detector.update({0, 0}, 0.1)) << i;
  EXPECT_TRUE(detector.update({0.059, 0}, 0.1));
  EXPECT_FALSE(detector.update({0.061, 0}, 0.1));
}

TEST(StuckDetector, AMovingRobotIsNeverStuck) {
  StuckDetector detector;
  detector.reset(kPeriod);
  for (int i = 0; i < 2000; ++i) {
    ASSERT_FALSE(detector.update({0.1 * kPeriod * i, 0}, 0.1));  // 0.1 m/s
  }
}

struct SequencerTest : ::testing::Test {
  SequencerTest() { sequencer.reset(kPeriod); }
  void ask(const Request& request) {
    if (intent.apply(request)) sequencer.begin(intent);
  }
  Sequencer sequencer{};
  Intent intent{};
};

TEST_F(SequencerTest, IdleWithoutAGoal) {
  EXPECT_EQ(sequencer.update({}, intent), Mission::Idle);
}

TEST_F(SequencerTest, ArrivesWithinReachAndStaysArrived) {
  ask(SetGoal{.position_W = {1, 0}});
  EXPECT_EQ(sequencer.update({0.89, 0, 0}, intent), Mission::Driving);  // 0.11 m > 0.10 m
  EXPECT_EQ(sequencer.update({0.91, 0, 0}, intent), Mission::Arrived);
  EXPECT_EQ(sequencer.update({0.5, 0, 0}, intent), Mission::Arrived);
  ask(SetGoal{.position_W = {2, 0}});
  EXPECT_EQ(sequencer.update({0.91, 0, 0}, intent), Mission::Driving);
}

TEST_F(SequencerTest, ALoopNeverArrivesUnlessAllItsGoalsAreHere) {
  ask(SetGoals{{{.position_W = {1, 0}}, {.position_W = {2, 0}}}, 0, true});
  EXPECT_EQ(sequencer.update({1, 0, 0}, intent), Mission::Driving);
  EXPECT_EQ(sequencer.update({2, 0, 0}, intent), Mission::Driving);
  EXPECT_EQ(intent.goal->position_W.x(), 1);
  ask(SetGoals{{{.position_W = {1, 0}}, {.position_W = {1.01, 0}}}, 0, true});
  EXPECT_EQ(sequencer.update({1, 0, 0}, intent), Mission::Arrived);
}

TEST_F(SequencerTest, AWantedHeadingMustBeReachedToo) {
  ask(SetGoal{.position_W = {1, 0}, .heading = 1.0});
  EXPECT_EQ(sequencer.update({1, 0, 0.9}, intent), Mission::Driving);
  EXPECT_EQ(sequencer.update({1, 0, 0.96}, intent), Mission::Arrived);
}

TEST_F(SequencerTest, GoesOnFromGoalToGoalAndArrivesAtTheLast) {
  ask(AddGoal{{.position_W = {1, 0}}});  // the first, as there is none
  ask(AddGoal{{.position_W = {2, 0}, .heading = 1.0}});
  ask(AddGoal{{.position_W = {2, 0.05}}});
  EXPECT_EQ(sequencer.update({0.5, 0, 0}, intent), Mission::Driving);
  EXPECT_EQ(intent.goals_ahead.size(), 2U);
  EXPECT_EQ(sequencer.update({0.95, 0, 0}, intent), Mission::Driving);
  EXPECT_EQ(intent.goal, (SetGoal{.position_W = {2, 0}, .heading = 1.0}));
  EXPECT_EQ(sequencer.update({2, 0, 0}, intent), Mission::Driving);
  EXPECT_EQ(intent.goals_ahead.size(), 1U);
  // Within reach of both that are left.
  EXPECT_EQ(sequencer.update({2, 0, 1}, intent), Mission::Arrived);
  EXPECT_EQ(intent.goal, SetGoal{.position_W = Vec2(2, 0.05)});
  ask(AddGoal{{.position_W = {3, 0}}});
  EXPECT_EQ(sequencer.update({2, 0, 1}, intent), Mission::Driving);
  EXPECT_EQ(intent.goal, SetGoal{.position_W = Vec2(3, 0)});
}

TEST_F(SequencerTest, ANewGoalReplacesAllOthers) {
  ask(AddGoal{{.position_W = {1, 0}}});
  ask(AddGoal{{.position_W = {2, 0}}});
  ask(SetGoal{.position_W = {0, 5}});
  EXPECT_TRUE(intent.goals_ahead.empty());
  ask(AddGoal{{.position_W = {2, 0}}});
  ask(ClearGoal{});
  EXPECT_EQ(sequencer.update({}, intent), Mission::Idle);
}

TEST_F(SequencerTest, StuckUntilItGetsAway) {
  ask(SetGoal{.position_W = {5, 0}});
  Mission mission = Mission::Driving;
  for (int i = 0; i < 500; ++i) mission = sequencer.update({1, 0, 0}, intent);
  EXPECT_EQ(mission, Mission::Stuck);
  EXPECT_EQ(sequencer.update({1.05, 0, 0}, intent), Mission::Stuck);
  EXPECT_EQ(sequencer.update({1.2, 0, 0}, intent), Mission::Driving);
}

TEST_F(SequencerTest, AHeldRobotIsNotStuck) {
  ask(SetGoal{.position_W = {5, 0}});
  for (int i = 0; i < 2000; ++i) {
    sequencer.interrupt();
    ASSERT_EQ(sequencer.update({1, 0, 0}, intent), Mission::Driving);
  }
}

}  // namespace
}  // namespace algo
