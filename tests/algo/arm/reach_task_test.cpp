// tests/algo/arm/reach_task_test.cpp: a reach from its plan to the hand at its goal, also where the
// world does not keep to the plan.
#include "algo/arm/reach_task.hpp"

#include "tests/algo/allocations.hpp"
#include "tests/algo/arm/reach_scene.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

using algo::BodyJoints;
using algo::ReachTask;
using reach_scene::Scene;

constexpr double kReachTick = 0.05;  // [s]

/// A body that moves as commanded, while things move on.
struct ReachDrive {
  explicit ReachDrive(const Scene& which) : scene(which), task(which.body, {}) {
    task.begin(scene.start, {scene.hand_W}, scene.solids, 5);
    answer_at_once(task, scene.body, q, scene.solids);
  }
  void tick() {
    const algo::BodyCommand command = task.update(q, scene.solids, scene.solids, kReachTick);
    answer_at_once(task, scene.body, q, scene.solids);
    waited = waited || task.state() == ReachTask::State::Waits;
    q = moved(q, command, kReachTick);
    for (algo::Solid& solid : scene.solids) solid = solid.after(kReachTick);
    const auto frames = body_frames(scene.body, q);
    room = std::min(room, clearance(scene.body, frames, scene.solids).smallest());
  }
  /// Until `done()`, or the task has ended, or `longest` [s] have passed.
  template <typename Done>
  void run_until(Done&& done, double longest = 90) {
    for (double time = 0; time < longest && !ended() && !done(); time += kReachTick) tick();
  }
  void run() {
    run_until([] { return false; });
  }
  bool ended() const {
    return task.state() == ReachTask::State::Arrived || task.state() == ReachTask::State::GivenUp;
  }
  double hand_error() const {
    return (body_frames(scene.body, q).hand() - scene.hand_W.translation()).norm();
  }

  Scene scene;
  ReachTask task;
  BodyJoints q = scene.start;
  bool waited = false;
  double room = 1e9;  // [m] least
};

TEST(ReachTask, BringsTheHandToItsGoalPastWhatStands) {
  ReachDrive drive(reach_scene::over_a_table());
  drive.run();
  EXPECT_EQ(drive.task.words(), "The hand is at its goal.");
  EXPECT_LT(drive.hand_error(), 0.005);
  EXPECT_GT(drive.room, 0.04);
  EXPECT_EQ(drive.task.plans(), 1);
}

TEST(ReachTask, PlansAnewWhenTheBaseIsPushedOffItsPlace) {
  ReachDrive drive(reach_scene::free_goal(0.95));
  drive.run_until([&] { return drive.task.words() == "The robot drives."; });
  drive.run_until([&] { return drive.task.words() == "The robot moves its arm."; });
  ASSERT_EQ(drive.task.words(), "The robot moves its arm.");
  drive.q[0] -= 0.8;
  drive.run();
  EXPECT_EQ(drive.task.words(), "The hand is at its goal.");
  EXPECT_LT(drive.hand_error(), 0.005);
  EXPECT_EQ(drive.task.plans(), 2);
}

TEST(ReachTask, WaitsForAPostThatCrossesAndGoesOn) {
  Scene scene = reach_scene::free_goal(0.95);
  scene.solids = {reach_scene::post({1.0, -1.2}, {0, 0.2})};
  ReachDrive drive(scene);
  drive.run();
  EXPECT_TRUE(drive.waited);
  EXPECT_EQ(drive.task.words(), "The hand is at its goal.");
  EXPECT_GT(drive.room, 0);
}

TEST(ReachTask, KeepsItsPlanWhereThereIsNoOther) {
  ReachDrive drive(reach_scene::free_goal(0.95));
  drive.run_until([&] { return drive.q[0] > 0.5; });
  // A gate shuts before the robot for longer than its patience.
  const algo::Vec2 ahead = algo::base_of(drive.q).position() + algo::Vec2(0.44, 0);
  drive.scene.solids = {reach_scene::board(ahead, {0.05, 30}, 0, 1.6)};
  drive.run_until([] { return false; }, 6);
  EXPECT_EQ(drive.task.words(), "The robot waits: something is too near to go on.");
  EXPECT_EQ(drive.task.plans(), 2);
  drive.scene.solids.clear();
  drive.run();
  EXPECT_EQ(drive.task.words(), "The hand is at its goal.");
}

TEST(ReachTask, GivesUpWithTheReason) {
  Scene high = reach_scene::free_goal(3);
  ReachDrive drive(high);
  EXPECT_EQ(drive.task.state(), ReachTask::State::GivenUp);
  EXPECT_THAT(drive.task.words(),
              ::testing::HasSubstr("m from the shoulder, and the farthest it can be is"));
  drive.tick();
  EXPECT_EQ(drive.q, drive.scene.start);
}

TEST(ReachTask, FollowsAPathWithTheHandFromItsGoalOnAndComesBack) {
  Scene scene = reach_scene::over_a_table();
  algo::ReachGoal goal{.hand_W = scene.hand_W};
  const algo::Vec3 there_W = scene.hand_W.translation();
  goal.path_W = {there_W + algo::Vec3(0, 0.10, 0), there_W + algo::Vec3(0, 0.10, 0.05)};
  ReachTask task(scene.body, {});
  BodyJoints q = scene.start;
  task.begin(q, goal, scene.solids, 5);
  answer_at_once(task, scene.body, q, scene.solids);
  bool followed = false;
  for (double time = 0; time < 120 && task.state() != ReachTask::State::Arrived;
       time += kReachTick) {
    ASSERT_NE(task.state(), ReachTask::State::GivenUp) << task.words();
    const auto command = task.update(q, scene.solids, scene.solids, kReachTick);
    answer_at_once(task, scene.body, q, scene.solids);
    followed = followed || task.words() == "The robot follows its path with the hand.";
    q = moved(q, command, kReachTick);
  }
  EXPECT_TRUE(followed);
  EXPECT_EQ(task.words(), "The hand is at the end of its path.");
  EXPECT_LT((body_frames(scene.body, q).hand() - goal.path_W.back()).norm(), 0.005);
}

TEST(ReachTask, PlansThroughWhatMoves) {
  Scene scene = reach_scene::over_a_table();
  algo::Solid walker;
  walker.centre_W = {0.8, 0};
  walker.rounding = 0.25;
  for (const double speed : {0.0, 0.3}) {
    walker.velocity_W = {0, speed};
    scene.solids.push_back(walker);
    ReachTask task(scene.body, {});
    task.begin(scene.start, {scene.hand_W}, scene.solids, 5);
    ASSERT_NE(task.question(), nullptr);
    const bool counts = task.question()->solids.size() == scene.solids.size();
    EXPECT_EQ(counts, speed == 0) << speed;
    scene.solids.pop_back();
  }
}

TEST(ReachTask, ATickOfALegAllocatesNothing) {
  ReachDrive drive(reach_scene::free_goal(0.95));
  drive.run_until([&] { return drive.q[0] > 0.5; });
  const auto before = allocations::count();
  for (int n = 0; n < 5; ++n)
    drive.task.update(drive.q, drive.scene.solids, drive.scene.solids, kReachTick);
  EXPECT_EQ(allocations::count(), before);
}

}  // namespace
