// tests/algo/intent_test.cpp: the effect of each request.
#include "algo/intent.hpp"

#include <gtest/gtest.h>

#include "algo/driving.hpp"

namespace algo {
namespace {

SetGoal goal(double x) {
  return {.position_W = {x, 0}};
}

TEST(Intent, GoalsQueueAndANewOneReplacesAll) {
  Intent intent;
  EXPECT_TRUE(intent.apply(AddGoal{goal(1)}));  // the first, as there is none
  EXPECT_FALSE(intent.apply(AddGoal{goal(2)}));
  EXPECT_FALSE(intent.apply(AddGoal{goal(3)}));
  EXPECT_EQ(intent.goal, goal(1));
  EXPECT_EQ(intent.goals_ahead, (std::vector{goal(2), goal(3)}));
  intent.go_on();
  EXPECT_EQ(intent.goal, goal(2));
  EXPECT_EQ(intent.goals_ahead, std::vector{goal(3)});
  EXPECT_TRUE(intent.apply(goal(9)));
  EXPECT_EQ(intent.goal, goal(9));
  EXPECT_TRUE(intent.goals_ahead.empty());
  EXPECT_TRUE(intent.apply(ClearGoal{}));
  EXPECT_FALSE(intent.goal);
}

TEST(Intent, AListOfGoalsReplacesAllAndKeepsTheWayToThePresentOne) {
  Intent intent;
  EXPECT_TRUE(intent.apply(SetGoals{{goal(1), goal(2), goal(3)}}));
  EXPECT_EQ(intent.goal, goal(1));
  intent.go_on();
  EXPECT_FALSE(intent.apply(SetGoals{{goal(3), goal(2), goal(1)}, 1}));  // in another order
  EXPECT_EQ(intent.goal, goal(2));
  EXPECT_EQ(intent.goals_behind, std::vector{goal(3)});
  EXPECT_EQ(intent.goals_ahead, std::vector{goal(1)});
  EXPECT_EQ(intent.route(), (std::vector{goal(3), goal(2), goal(1)}));
  EXPECT_TRUE(intent.apply(SetGoals{}));
  EXPECT_FALSE(intent.goal);
  EXPECT_TRUE(intent.route().empty());
}

TEST(Intent, ALoopGoesOnFromTheLastGoalToTheFirst) {
  Intent intent;
  intent.apply(SetGoals{{goal(1), goal(2)}, 0, true});
  for (const double x : {2, 1, 2, 1}) {
    ASSERT_TRUE(intent.has_next());
    intent.go_on();
    EXPECT_EQ(intent.goal, goal(x));
    EXPECT_EQ(intent.route(), (std::vector{goal(1), goal(2)}));
  }
  intent.apply(SetGoals{{goal(1)}, 0, true});
  EXPECT_FALSE(intent.has_next());
}

TEST(Intent, RemembersABoundedNumberOfReachedGoals) {
  Intent intent;
  intent.reserve();
  const auto room = intent.goals_behind.capacity();
  for (int i = 0; i < 1000; ++i) {
    intent.apply(AddGoal{goal(i)});
    if (i > 0) intent.go_on();
  }
  EXPECT_EQ(intent.goals_behind.size(), kMostGoalsAhead);
  EXPECT_EQ(intent.goals_behind.back(), goal(998));
  EXPECT_EQ(intent.goals_behind.capacity(), room);
}

TEST(Intent, AChangedObstacleTakesThePlaceOfTheOldOne) {
  Intent intent;
  const Obstacle before{.id = 1, .pose_W = {1, 0, 0}, .shape = Cylinder{0.2}};
  const Obstacle after{.id = 1, .pose_W = {2, 0, 0}, .shape = Box{1, 2}};
  intent.apply(AddObstacle{before});
  EXPECT_FALSE(intent.apply(ChangeObstacle{after}));
  EXPECT_EQ(intent.obstacles, std::vector{after});
  EXPECT_TRUE(is_edit(ChangeObstacle{after}));
}

TEST(Intent, TakingTheStickCancelsTheGoalsAndReleaseRestoresNone) {
  Intent intent;
  intent.apply(goal(1));
  EXPECT_FALSE(intent.apply(Joystick{}));
  EXPECT_TRUE(intent.goal);
  EXPECT_TRUE(intent.apply(Joystick{0, 0.1}));
  EXPECT_FALSE(intent.goal);
  EXPECT_EQ(intent.stick, (Joystick{0, 0.1}));
  intent.apply(Joystick{});
  EXPECT_FALSE(intent.goal);
}

TEST(Intent, StopLatchesAndKeepsTheGoal) {
  Intent intent;
  intent.apply(goal(1));
  EXPECT_FALSE(intent.apply(Stop{true}));
  EXPECT_TRUE(intent.stop);
  EXPECT_TRUE(intent.goal);
  intent.apply(Stop{false});
  EXPECT_FALSE(intent.stop);
}

TEST(Intent, ObstaclesAndParametersAreAsLastAsked) {
  Intent intent;
  const Obstacle a{.id = 1, .pose_W = {1, 0, 0}, .shape = Cylinder{0.2}};
  const Obstacle b{.id = 2, .pose_W = {2, 0, 0}, .shape = Cylinder{0.2}};
  for (const Request& edit : {Request{AddObstacle{a}},
                              Request{AddObstacle{b}},
                              Request{MoveObstacle{2, {5, 0, 0}}},
                              Request{MoveObstacle{7, {5, 0, 0}}},
                              Request{RemoveObstacle{1}},
                              Request{RemoveObstacle{1}}}) {
    EXPECT_TRUE(is_edit(edit));
    EXPECT_FALSE(intent.apply(edit));
  }
  ASSERT_EQ(intent.obstacles.size(), 1U);
  EXPECT_EQ(intent.obstacles[0].id, 2U);
  EXPECT_EQ(intent.obstacles[0].pose_W.x, 5);
  intent.apply(SetParameter{&algo::kMaxSpeed, 0.25});
  EXPECT_EQ(intent.parameters[algo::kMaxSpeed], 0.25);
  EXPECT_FALSE(is_edit(goal(1)));
}

}  // namespace
}  // namespace algo
