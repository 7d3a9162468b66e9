// tests/server/experiment/oracle_test.cpp: avoidable and unavoidable contacts.
#include "server/experiment/oracle.hpp"

#include <gtest/gtest.h>

namespace server::experiment {
namespace {

/// A cylinder that comes at 1 m/s towards the origin, where the robot stands or drives.
sim::Scenario oncoming() {
  sim::Scenario scenario;
  algo::Obstacle cylinder{.id = 1, .shape = algo::Cylinder{.radius = 0.5}};
  cylinder.pose_W = {10, 0, 0};
  cylinder.path = {.period = 20, .keys = {{0, {10, 0}}, {20, {-10, 0}}}};
  scenario.obstacles.push_back(cylinder);
  return scenario;
}

TEST(Oracle, AStandingRobotInTheWayCouldHaveAvoidedContact) {
  const algo::RobotSpec spec{.radius = 0.35,
                             .max_v = 1,
                             .max_omega = 2,
                             .max_acceleration = 2,
                             .max_angular_acceleration = 4};
  std::vector<Moment> trail;
  for (int k = 0; k <= 60; ++k) trail.push_back({6.15 + 0.05 * k, {0, 0, 1.57}, {}});
  EXPECT_EQ(judge_contact(oncoming(), spec, trail), Contact::Avoidable);
  // A robot that can hardly move could not.
  algo::RobotSpec lame = spec;
  lame.max_v = lame.max_omega = 0.01;
  EXPECT_EQ(judge_contact(oncoming(), lame, trail), Contact::Unavoidable);
}

TEST(Oracle, AnObstacleThatJumpedIsNotTheRobotsFault) {
  const algo::RobotSpec spec{.radius = 0.35, .max_v = 1, .max_omega = 2, .max_acceleration = 2};
  std::vector<Moment> trail;
  for (int k = 0; k <= 60; ++k) trail.push_back({18.0 + 0.05 * k, {9.1, 0, 0}, {}});
  EXPECT_EQ(judge_contact(oncoming(), spec, trail), Contact::Jumped);
}

/// One who comes and goes is in nobody's way before, and appears from nowhere.
TEST(Oracle, SomebodyWhoIsAwayIsNotInTheWayAndOneWhoAppearsHasJumped) {
  const algo::RobotSpec spec{.radius = 0.35, .max_v = 1, .max_omega = 2, .max_acceleration = 2};
  sim::Scenario scenario = oncoming();
  scenario.obstacles[0].path = {
      .period = 20, .keys = {{5, {0.5, 0}}, {8, {0.5, 0}}}, .comes_and_goes = true};
  const auto trail_to = [](double stamp) {
    std::vector<Moment> trail;
    for (int k = 0; k <= 60; ++k) trail.push_back({stamp - 3 + 0.05 * k, {0, 0, 0}, {}});
    return trail;
  };
  EXPECT_EQ(judge_contact(scenario, spec, trail_to(6)), Contact::Jumped);
  EXPECT_EQ(judge_contact(scenario, spec, trail_to(15)), Contact::Avoidable);
}

}  // namespace
}  // namespace server::experiment
