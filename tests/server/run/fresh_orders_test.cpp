// tests/server/run/fresh_orders_test.cpp: neither arming nor a release sets a real robot in motion.
#include "server/run/fresh_orders.hpp"

#include <gtest/gtest.h>

namespace server {
namespace {

const algo::Request kGoal = algo::SetGoal{{3, 0}, {}};
const algo::Request kPushed = algo::Joystick{0.5, 0};
const algo::Request kLetGo = algo::Joystick{};
const algo::Request kStop = algo::Stop{true};
const algo::Request kRelease = algo::Stop{false};

TEST(FreshOrdersTest, GoalsAndTheStickAreRefusedWhileTheMotorsAreOff) {
  FreshOrders orders;
  EXPECT_NE(orders.refusal(kGoal, 0).value_or("").find("Arm the robot first"), std::string::npos);
  EXPECT_TRUE(orders.refusal(algo::AddGoal{{{1, 0}, {}}}, 0));
  EXPECT_TRUE(orders.refusal(kPushed, 0));
  for (const algo::Request& harmless :
       {kLetGo, kStop, kRelease, algo::Request{algo::ClearGoal{}}}) {
    EXPECT_FALSE(orders.refusal(harmless, 0));
  }
  EXPECT_FALSE(orders.notice(1));
  EXPECT_FALSE(orders.refusal(kGoal, 1));
}

TEST(FreshOrdersTest, EvenABriefDisarmingCancelsEarlierOrders) {
  FreshOrders orders;
  orders.notice(1);
  EXPECT_FALSE(orders.accept(kGoal));
  EXPECT_TRUE(orders.notice(0));
  orders.accept(algo::ClearGoal{});
  EXPECT_FALSE(orders.notice(2));
  // WHEN it was disarmed and armed again between two polls THEN the goal is void too.
  orders.accept(kGoal);
  EXPECT_TRUE(orders.notice(3));
  orders.accept(algo::ClearGoal{});
  orders.accept(kPushed);
  EXPECT_TRUE(orders.notice(0));
}

TEST(FreshOrdersTest, StopCancelsGoalsAndAReleaseRestoresNone) {
  FreshOrders orders;
  orders.notice(1);
  orders.accept(kGoal);
  EXPECT_TRUE(orders.accept(kStop));
  orders.accept(algo::ClearGoal{});
  EXPECT_NE(orders.refusal(kGoal, 0).value_or("").find("Release Stop first"), std::string::npos);
  EXPECT_FALSE(orders.accept(kRelease));
  EXPECT_FALSE(orders.goal());
  EXPECT_FALSE(orders.refusal(kGoal, 0));
}

TEST(FreshOrdersTest, AStickHeldMeanwhileMustBeReleased) {
  FreshOrders orders;
  for (double now = 0; now < 1; now += 0.05) EXPECT_TRUE(orders.refusal(kPushed, now));
  orders.notice(1);  // GIVEN an operator arms while the stick is held
  for (double now = 1; now < 5; now += 0.05) EXPECT_TRUE(orders.refusal(kPushed, now)) << now;
  // WHEN the stick is released or silent THEN it counts again.
  EXPECT_FALSE(orders.refusal(kLetGo, 5));
  EXPECT_FALSE(orders.refusal(kPushed, 5.1));
  orders.accept(kStop);
  EXPECT_TRUE(orders.refusal(kPushed, 5.2));
  orders.accept(kRelease);
  EXPECT_TRUE(orders.refusal(kPushed, 5.3));
  EXPECT_FALSE(orders.refusal(kPushed, 6));
}

}  // namespace
}  // namespace server
