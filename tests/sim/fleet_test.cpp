// tests/sim/fleet_test.cpp: robots that see and touch one another in one world.
#include "sim/fleet.hpp"

#include <atomic>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/sim/reference_world.hpp"
#include <gtest/gtest.h>

#include "server/run/robot_library.hpp"

namespace sim {
namespace {

/// Robots of `robot` with an ideal scanner, the first at the origin looking along x.
Scenario scenario_with(std::vector<algo::Pose2> others,
                       PhysicsKind physics = PhysicsKind::Kinematic) {
  Scenario scenario;
  scenario.physics = physics;
  scenario.robot.sensors.lasers = {LaserConfig::ideal(0.5)};
  for (const algo::Pose2& start : others) scenario.robots.emplace_back().start = start;
  return scenario;
}

/// The range of the middle beam, straight ahead.
double ahead(const algo::Observation& observation) {
  const algo::LaserScan& scan = observation.scans[0];
  return scan.ranges[scan.size() / 2];
}

std::string complaint_about(const Scenario& scenario) {
  try {
    const Fleet fleet(scenario, 1);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "made";
}

/// Advances with `threads` threads.
ForEach on_threads(std::size_t threads) {
  return [threads](std::size_t count, const std::function<void(std::size_t)>& call) {
    std::atomic<std::size_t> next{0};
    std::vector<std::jthread> crew;
    for (std::size_t i = 0; i < threads; ++i) {
      crew.emplace_back([&] {
        for (std::size_t k = next++; k < count; k = next++) call(k);
      });
    }
  };
}

TEST(Fleet, ARobotSeesAnotherWhereItStands) {
  Fleet fleet(scenario_with({{3, 0, 1}, {0, -2, 0}}), 1);
  algo::Observation seen;
  fleet.read(0, seen);
  EXPECT_NEAR(ahead(seen), 3 - 0.35, 1e-3);
  const algo::LaserScan& scan = seen.scans[0];
  EXPECT_NEAR(scan.ranges[0], 2 - 0.35, 1e-3);  // straight to the right
  EXPECT_EQ(scan.status[scan.size() - 1], algo::Beam::Free);
  EXPECT_NEAR(fleet.robot(0).ground_truth()->obstacle_distance, 2 - 0.35, 1e-12);
  EXPECT_NEAR(fleet.robot(0).ground_truth()->clearance, 2 - 0.7, 1e-12);
}

TEST(Fleet, ARectangularRobotIsSeenAsARectangle) {
  Scenario scenario = scenario_with({{3, 0, 0}});
  scenario.robots[0].robot = server::builtin_robot("jackal");  // 0.508 m long
  Fleet fleet(scenario, 1);
  algo::Observation seen;
  fleet.read(0, seen);
  EXPECT_NEAR(ahead(seen), 3 - 0.254, 1e-3);
}

TEST(Fleet, ADrivingRobotIsSeenAtItsPresentPose) {
  for (const PhysicsKind physics : {PhysicsKind::Kinematic, PhysicsKind::Bullet}) {
    Fleet fleet(scenario_with({{3, 0, 0}}, physics), 1);
    algo::Observation seen;
    algo::Observation other;
    fleet.read(0, seen);
    fleet.read(1, other);
    for (int tick = 0; tick < 100; ++tick) {
      fleet.write(1, {{0.4, 0}});
      fleet.advance();
      fleet.read(0, seen);
      fleet.read(1, other);
      EXPECT_NEAR(ahead(seen), fleet.robot(1).pose_W().x - 0.35, 2e-3);
    }
    EXPECT_GT(ahead(seen), 3.4);
  }
}

/// A robot beyond scanner range is left out of the world, and returns later.
TEST(Fleet, ARobotOutOfSightLeavesTheWorldAndComesBack) {
  Fleet fleet(scenario_with({{2, 1.5, 0}}), 1);
  algo::Observation seen;
  const auto drive = [&](double speed, int ticks) {
    for (int tick = 0; tick < ticks; ++tick) {
      fleet.write(1, {{speed, 0}});
      fleet.advance();
      fleet.read(0, seen);
    }
  };
  drive(0.5, 700);  // to 11.1 m
  EXPECT_TRUE(std::isinf(fleet.robot(0).ground_truth()->obstacle_distance));
  for (const algo::Beam beam : seen.scans[0].status) EXPECT_EQ(beam, algo::Beam::Free);
  drive(-0.5, 700);
  EXPECT_NEAR(fleet.robot(0).ground_truth()->obstacle_distance, std::hypot(2, 1.5) - 0.35, 1e-9);
}

TEST(Fleet, AFleetOfOneEqualsAWorld) {
  Scenario scenario;
  scenario.obstacles = reference::room(20);
  Fleet fleet(scenario, 7);
  World world(scenario, 7);
  algo::Observation a;
  algo::Observation b;
  fleet.read(0, a);
  world.reset(b);
  for (int tick = 0; tick < 200; ++tick) {
    const algo::Command command{{0.4, 0.7}};
    fleet.write(0, command);
    fleet.advance();
    fleet.read(0, a);
    world.step(command, b);
    ASSERT_EQ(a.odometry.pose, b.odometry.pose);
    ASSERT_EQ(a.scans.size(), b.scans.size());
    for (std::size_t i = 0; i < a.scans.size(); ++i) {
      ASSERT_EQ(a.scans[i].ranges, b.scans[i].ranges);
    }
  }
}

/// One robot drives into a standing one: both bumpers report, neither robot is pushed.
TEST(Fleet, ARobotDrivenIntoAnotherStopsAndBothBumpersReport) {
  for (const PhysicsKind physics : {PhysicsKind::Kinematic, PhysicsKind::Bullet}) {
    Fleet fleet(scenario_with({{1.5, 0, 0}}, physics), 1);
    algo::Observation a;
    algo::Observation b;
    bool pressed_a = false;
    bool pressed_b = false;
    bool collided_a = false;
    bool collided_b = false;
    for (int tick = 0; tick < 300; ++tick) {
      fleet.write(0, {{0.4, 0}});
      fleet.advance();
      fleet.read(0, a);
      fleet.read(1, b);
      pressed_a = pressed_a || a.bumpers[0].pressed;
      pressed_b = pressed_b || b.bumpers[0].pressed;
      collided_a = collided_a || fleet.robot(0).ground_truth()->collided;
      collided_b = collided_b || fleet.robot(1).ground_truth()->collided;
    }
    EXPECT_TRUE(pressed_a && pressed_b && collided_a && collided_b)
        << pressed_a << pressed_b << collided_a << collided_b;
    EXPECT_NEAR(fleet.robot(0).pose_W().x, 1.5 - 0.7, 0.02);
    EXPECT_NEAR(fleet.robot(1).pose_W().x, 1.5, 1e-9);
    EXPECT_NEAR(fleet.robot(0).ground_truth()->clearance, 0, 0.02);
  }
}

/// A robot that touches an obstacle beside another robot does not touch that robot.
TEST(Fleet, ContactWithAnObstacleIsNotContactWithARobot) {
  Scenario scenario = scenario_with({{0.6, 0.8, 0}});
  scenario.obstacles.push_back({.id = 1, .pose_W = {0.8, 0, 0}, .shape = algo::Box{0.4, 0.4}});
  Fleet fleet(scenario, 1);
  algo::Observation a;
  algo::Observation b;
  for (int tick = 0; tick < 100; ++tick) {
    fleet.write(0, {{0.4, 0}});
    fleet.advance();
    fleet.read(0, a);
    fleet.read(1, b);
    EXPECT_FALSE(b.bumpers[0].pressed);
  }
  EXPECT_TRUE(a.bumpers[0].pressed);
}

/// Every number of `fleet` in some ticks of a wandering, colliding crowd.
std::vector<double> wander(Fleet& fleet) {
  std::vector<double> numbers;
  std::vector<algo::Observation> seen(fleet.size());
  fleet.restart();
  for (int tick = 0; tick < 150; ++tick) {
    for (std::size_t k = 0; k < fleet.size(); ++k) {
      fleet.write(k, {{0.5, 0.6 * std::sin(0.03 * tick + static_cast<double>(k))}});
    }
    fleet.advance();
    fleet.each([&](std::size_t k) { fleet.read(k, seen[k]); });
    for (std::size_t k = 0; k < fleet.size(); ++k) {
      const algo::Pose2& pose_W = fleet.robot(k).pose_W();
      numbers.insert(numbers.end(), {pose_W.x, pose_W.y, pose_W.heading});
      numbers.push_back(seen[k].bumpers[0].pressed ? 1 : 0);
      numbers.push_back(fleet.robot(k).ground_truth()->clearance);
      for (const algo::LaserScan& scan : seen[k].scans) {
        numbers.insert(numbers.end(), scan.ranges.begin(), scan.ranges.end());
      }
    }
  }
  return numbers;
}

Scenario crowd(PhysicsKind physics) {
  Scenario scenario;
  scenario.physics = physics;
  scenario.obstacles = reference::room(20);
  scenario.robot.sensors.lasers.front().salt = 0.01;
  for (int k = 1; k < 9; ++k) {
    const double bearing = 0.7 * k;
    const algo::Vec2 at = 1.25 * algo::direction(bearing);
    scenario.robots.emplace_back().start = {at.x(), at.y(), bearing + 2.5};
  }
  scenario.robots[2].robot = server::builtin_robot("robhaz");
  return scenario;
}

TEST(Fleet, TheSameBitForBitOnOneTwoAndFourThreads) {
  for (const PhysicsKind physics : {PhysicsKind::Kinematic, PhysicsKind::Bullet}) {
    Fleet alone(crowd(physics), 3);
    const std::vector<double> expected = wander(alone);
    EXPECT_EQ(wander(alone), expected) << "again after restart";
    for (const std::size_t threads : {1U, 2U, 4U}) {
      Fleet fleet(crowd(physics), 3, on_threads(threads));
      EXPECT_EQ(wander(fleet), expected) << threads << " threads";
    }
    Fleet other(crowd(physics), 4);
    EXPECT_NE(wander(other), expected) << "another seed";
  }
}

TEST(Fleet, EachRobotHasItsOwnNoise) {
  Scenario scenario;
  scenario.robots.emplace_back().start = {100, 0, 0};
  scenario.robots.emplace_back().start = {200, 0, 0};
  for (std::uint32_t k = 0; k < 3; ++k) {
    scenario.obstacles.push_back(
        {.id = k + 1, .pose_W = {100.0 * k + 3, 0, 0}, .shape = algo::Wall{0.2, 8}});
  }
  Fleet fleet(scenario, 1);
  std::vector<algo::Observation> seen(3);
  for (int tick = 0; tick < 2; ++tick) {
    fleet.advance();
    for (std::size_t k = 0; k < 3; ++k) fleet.read(k, seen[k]);
  }
  ASSERT_EQ(seen[0].scans.size(), 1U);
  EXPECT_NE(seen[0].scans[0].ranges, seen[1].scans[0].ranges);
  EXPECT_NE(seen[1].scans[0].ranges, seen[2].scans[0].ranges);
}

TEST(Fleet, RefusesStartsThatOverlap) {
  EXPECT_EQ(complaint_about(scenario_with({{3, 0, 0}, {3.6, 0, 0}})),
            "Robot 2 and Robot 3 overlap where they start.");
  EXPECT_EQ(complaint_about(scenario_with({{0.69, 0, 0}})),
            "Robot 1 and Robot 2 overlap where they start.");
  EXPECT_EQ(complaint_about(scenario_with({{0.71, 0, 0}})), "made");
  Scenario scenario = scenario_with({{3, 0, 0}});
  scenario.obstacles.push_back({.id = 1, .pose_W = {3.2, 0, 0}, .shape = algo::Cylinder{0.1}});
  EXPECT_EQ(complaint_about(scenario),
            "Robot 2: Obstacle 1 would overlap the robot: 0.25 m too close.");
  scenario.obstacles.clear();
  scenario.robots[0].robot.emplace().wheels.clear();
  EXPECT_EQ(complaint_about(scenario),
            "Robot 2: The scenario's robot: wheels: there must be one on each side at least.");
  scenario.robots.assign(kMostRobots, {});
  EXPECT_EQ(complaint_about(scenario), "A world holds at most 200 robots.");
}

TEST(Fleet, EditsReachEveryRobotOrNone) {
  Fleet fleet(scenario_with({{0, 3, 0}}), 1);
  algo::Observation seen;
  const algo::Obstacle post{.id = 5, .pose_W = {2, 3, 0}, .shape = algo::Cylinder{0.1}};
  EXPECT_EQ(fleet.edit(algo::AddObstacle{post}), std::nullopt);
  fleet.read(1, seen);
  EXPECT_NEAR(ahead(seen), 2 - 0.1, 1e-3);
  EXPECT_EQ(fleet.edit(algo::MoveObstacle{5, {0.3, 3, 0}}),
            "Robot 2: Obstacle 5 would overlap the robot: 0.15 m too close.");
  EXPECT_EQ(fleet.edit(algo::MoveObstacle{5, {2, 0, 0}}), std::nullopt);
  fleet.advance();
  fleet.read(0, seen);
  EXPECT_NEAR(ahead(seen), 2 - 0.1, 1e-3);
  fleet.read(1, seen);
  EXPECT_EQ(fleet.edit(algo::RemoveObstacle{5}), std::nullopt);
  EXPECT_EQ(fleet.edit(algo::RemoveObstacle{5}), "There is no obstacle 5.");
  fleet.advance();
  for (std::size_t k = 0; k < 2; ++k) fleet.read(k, seen);
  // The robots still see each other.
  EXPECT_NEAR(fleet.robot(0).ground_truth()->clearance, 3 - 0.7, 1e-9);
}

TEST(Fleet, RobotsCannotBeEdited) {
  Fleet fleet(scenario_with({{3, 0, 0}, {0, 3, 0}}), 1);
  const std::string refusal = "Robot 3 moves by itself.";
  EXPECT_EQ(fleet.edit(algo::MoveObstacle{kRobotIds + 3, {5, 5, 0}}), refusal);
  EXPECT_EQ(fleet.edit(algo::RemoveObstacle{kRobotIds + 3}), refusal);
  EXPECT_EQ(fleet.edit(algo::RemoveObstacle{kRobotIds + 4}), "There is no robot 4.");
}

TEST(Fleet, ReportsThePosesOfTheOthers) {
  const Scenario scenario = scenario_with({{3, 0, 0}, {0, 3, 1}});
  Fleet fleet(scenario, 1);
  fleet.write(2, {{0.5, 0}});
  fleet.advance();
  algo::Recycled<algo::Moved> moved;
  fleet.find_moved(moved);
  ASSERT_EQ(moved.size(), 2U);
  EXPECT_EQ(moved[0], (algo::Moved{kRobotIds + 2, {3, 0, 0}}));
  EXPECT_EQ(moved[1], (algo::Moved{kRobotIds + 3, fleet.robot(2).pose_W()}));
  const std::vector<algo::Obstacle> others = other_robots(scenario);
  ASSERT_EQ(others.size(), 2U);
  EXPECT_EQ(others[1].id, kRobotIds + 3);
  EXPECT_EQ(others[1].pose_W, (algo::Pose2{0, 3, 1}));
}

}  // namespace
}  // namespace sim
