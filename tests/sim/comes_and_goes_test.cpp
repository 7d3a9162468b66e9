// tests/sim/comes_and_goes_test.cpp: an obstacle that is nowhere outside its time.
#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "sim/world.hpp"

namespace sim {
namespace {

constexpr double kComes = 3;     // [s]
constexpr double kGoes = 5;      // [s]
constexpr double kCircle = 9;    // [s] until it comes again
constexpr double kPeriod = 0.1;  // [s]

/// Stands 2 m ahead of the start from kComes to kGoes.
algo::Obstacle visitor() {
  algo::Obstacle obstacle{.id = 1, .pose_W = {2, 0, 0}, .shape = algo::Cylinder{0.3}};
  obstacle.path = algo::ObstaclePath{
      .period = kCircle, .keys = {{kComes, {2, 0}}, {kGoes, {2, 0}}}, .comes_and_goes = true};
  return obstacle;
}

Scenario visited(PhysicsKind physics) {
  Scenario scenario;
  scenario.physics = physics;
  scenario.period = kPeriod;
  scenario.robot.sensors.sonar = SonarConfig{};
  scenario.robot.sensors.infrared.push_back({});
  scenario.obstacles = {visitor()};
  return scenario;
}

/// Steps `world` to the time `until` [s] of its clock.
void stand(World& world, double until, algo::Observation& observation) {
  const auto ticks = std::lround((until - observation.stamp) / kPeriod);
  for (long k = 0; k < ticks; ++k) world.step({}, observation);
}

double seen_ahead(const algo::Observation& observation) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const algo::LaserScan& scan : observation.scans) {
    const std::size_t middle = scan.size() / 2;
    if (scan.status[middle] == algo::Beam::Ok) nearest = std::min(nearest, scan.ranges[middle]);
  }
  return nearest;
}

/// Of sonar and infrared.
bool anything_near(const algo::Observation& observation) {
  const auto returned = [](const algo::RangeReading& reading) {
    return reading.status == algo::Beam::Ok && reading.range < 2;
  };
  return std::ranges::any_of(observation.sonar, returned) ||
         std::ranges::any_of(observation.infrared, returned);
}

class ComesAndGoes : public testing::TestWithParam<PhysicsKind> {};

TEST_P(ComesAndGoes, NoSensorSeesItOutsideItsTime) {
  World world(visited(GetParam()), 1);
  algo::Observation observation;
  world.reset(observation);
  algo::Recycled<algo::Moved> moved;
  const auto away = [&](double from, double until) {
    stand(world, from, observation);
    while (observation.stamp < until) {
      SCOPED_TRACE(observation.stamp);
      EXPECT_FALSE(std::isfinite(seen_ahead(observation)));
      EXPECT_FALSE(anything_near(observation));
      EXPECT_FALSE(std::isfinite(world.ground_truth()->obstacle_distance));
      EXPECT_FALSE(std::isfinite(world.ground_truth()->clearance));
      world.find_moved(moved);
      EXPECT_TRUE(moved.empty());
      world.step({}, observation);
    }
  };
  away(0, kComes - 1.5 * kPeriod);
  stand(world, kComes + 1, observation);
  EXPECT_NEAR(seen_ahead(observation), 1.7, 0.15);
  EXPECT_NEAR(world.ground_truth()->obstacle_distance, 1.7, 1e-9);
  world.find_moved(moved);
  ASSERT_EQ(moved.size(), 1U);
  bool heard = false;
  for (int k = 0; k < 5; ++k) {
    world.step({}, observation);
    heard = heard || anything_near(observation);
  }
  EXPECT_TRUE(heard);
  away(kGoes + 4 * kPeriod, kCircle + kComes - 1.5 * kPeriod);  // a turn of the scanner is over
  stand(world, kCircle + kComes + 1, observation);
  EXPECT_NEAR(seen_ahead(observation), 1.7, 0.15) << "it comes again";
}

TEST_P(ComesAndGoes, TheRobotDrivesThroughItsPlaceWhileItIsAwayAndNotWhileItIsThere) {
  World world(visited(GetParam()), 1);
  algo::Observation observation;
  const auto drive = [&](double until) {
    while (observation.stamp < until - kPeriod / 2) world.step({{0.5, 0}}, observation);
  };
  world.reset(observation);
  stand(world, kGoes + kPeriod, observation);
  drive(kCircle + kComes - kPeriod);
  EXPECT_GT(world.ground_truth()->pose.x, 2.7);
  EXPECT_FALSE(world.ground_truth()->collided);
  world.reset(observation);
  stand(world, kComes - 1, observation);
  drive(kGoes - kPeriod);
  EXPECT_LT(world.ground_truth()->pose.x, 1.4) << "the hull's front at 1.7 m";
}

TEST_P(ComesAndGoes, UntilItComesTheRunIsThatOfAnEmptyWorld) {
  Scenario empty = visited(GetParam());
  empty.obstacles.clear();
  World one(visited(GetParam()), 1);
  World other(empty, 1);
  algo::Observation a;
  algo::Observation b;
  one.reset(a);
  other.reset(b);
  for (int k = 0; k < 20; ++k) {
    one.step({{0.3, 0.2}}, a);
    other.step({{0.3, 0.2}}, b);
    EXPECT_EQ(a.odometry.pose, b.odometry.pose);
    ASSERT_EQ(a.scans.size(), b.scans.size());
    for (std::size_t i = 0; i < a.scans.size(); ++i)
      EXPECT_EQ(a.scans[i].ranges, b.scans[i].ranges);
  }
}

/// It may be put, changed and taken where the robot stands, as long as nobody is there.
TEST_P(ComesAndGoes, ItMayBeEditedWhileItIsAway) {
  Scenario scenario = visited(GetParam());
  scenario.obstacles.clear();
  World world(scenario, 1);
  algo::Observation observation;
  world.reset(observation);
  algo::Obstacle here = visitor();
  here.pose_W = {0, 0, 0};
  EXPECT_FALSE(world.edit(algo::AddObstacle{here}));
  EXPECT_FALSE(std::isfinite(world.ground_truth()->clearance)) << "at once";
  here.shape = algo::Cylinder{0.5};
  EXPECT_FALSE(world.edit(algo::ChangeObstacle{here}));
  world.step({}, observation);
  EXPECT_FALSE(std::isfinite(world.ground_truth()->clearance));
  stand(world, kComes + 1, observation);
  EXPECT_NEAR(world.ground_truth()->obstacle_distance, 1.5, 1e-9);
  EXPECT_FALSE(world.edit(algo::RemoveObstacle{1}));
  EXPECT_FALSE(std::isfinite(world.ground_truth()->clearance));
}

INSTANTIATE_TEST_SUITE_P(Physics,
                         ComesAndGoes,
                         testing::Values(PhysicsKind::Kinematic, PhysicsKind::Bullet));

/// A ramp far away makes the sensors cast rays in space.
TEST(ComesAndGoesOnUnevenGround, TheScannerSeesItInItsTimeOnly) {
  Scenario scenario = visited(PhysicsKind::Bullet);
  scenario.obstacles.push_back(
      {.id = 2, .pose_W = {-50, 0, 0}, .shape = algo::Ramp{2, 1, 0}, .height = 0.2});
  World world(scenario, 1);
  algo::Observation observation;
  world.reset(observation);
  stand(world, kComes - 2 * kPeriod, observation);
  EXPECT_FALSE(std::isfinite(seen_ahead(observation)));
  stand(world, kComes + 1, observation);
  EXPECT_NEAR(seen_ahead(observation), 1.7, 0.15);
  stand(world, kGoes + 4 * kPeriod, observation);
  EXPECT_FALSE(std::isfinite(seen_ahead(observation)));
}

}  // namespace
}  // namespace sim
