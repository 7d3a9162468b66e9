// tests/server/run/fleet_robot_test.cpp: several robots behind the interface of the first.
#include "server/run/fleet_robot.hpp"

#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "algo/pipeline/parameter_table.hpp"
#include "server/run/run_spec.hpp"
#include "server/run/runner.hpp"
#include "server/run/scenario_library.hpp"
#include "sim/world.hpp"

namespace server {
namespace {

sim::Scenario swap(sim::PhysicsKind physics) {
  sim::Scenario scenario = ScenarioLibrary({}, {}).load("swap");
  scenario.physics = physics;
  return scenario;
}

/// The results of each tick of a run of `spec`, for `seconds`.
template <typename See>
void drive(const RunSpec& spec, algo::Robot& robot, double seconds, See see) {
  algo::Pipeline pipeline(pipeline_config(spec), robot.spec());
  const auto pool = FramePool::make(2);
  RunLinks links;
  links.pool = pool.get();
  links.listeners.push_back([&](const Frame& frame) { see(frame.telemetry); });
  std::stop_source stop;
  links.listeners.push_back([&](const Frame& frame) {
    if (frame.telemetry.observation.stamp >= seconds) stop.request_stop();
  });
  run(robot, pipeline, first_requests(spec), {}, links, stop.get_token());
}

TEST(FleetRobot, EachRobotDrivesToItsOwnGoal) {
  const RunSpec spec = make_spec(swap(sim::PhysicsKind::Bullet), {});
  const auto robot = make_robot(spec);
  const auto* fleet = dynamic_cast<const FleetRobot*>(robot.get());
  ASSERT_NE(fleet, nullptr);
  std::vector<double> nearest(8, 100);  // [m] to its goal
  drive(spec, *robot, 75, [&](const algo::Telemetry& t) {
    ASSERT_EQ(t.moved.size(), 7U);
    for (std::uint32_t k = 1; k < 8; ++k) {
      const algo::Pose2& pose_W = fleet->fleet().robot(k).pose_W();
      EXPECT_EQ(t.moved[k - 1], (algo::Moved{sim::kRobotIds + k + 1, pose_W}));
      const algo::Vec2 goal_W = (*spec.scenario.robots[k - 1].goals)[0].position_W;
      nearest[k] = std::min(nearest[k], (pose_W.position() - goal_W).norm());
    }
  });
  for (std::uint32_t k = 1; k < 8; ++k) EXPECT_LT(nearest[k], 0.5) << "Robot " << k + 1;
}

/// The numbers of a run of the first robot.
std::vector<double> numbers(const RunSpec& spec, algo::Robot& robot) {
  std::vector<double> out;
  drive(spec, robot, 8, [&](const algo::Telemetry& t) {
    out.insert(out.end(),
               {t.command.base.v, t.command.base.omega, t.ground_truth->pose.x, t.clearance});
    for (const algo::LaserScan& scan : t.observation.scans) {
      out.insert(out.end(), scan.ranges.begin(), scan.ranges.end());
    }
    for (const algo::Moved& moved : t.moved) {
      out.insert(out.end(), {moved.pose_W.x, moved.pose_W.y, moved.pose_W.heading});
    }
  });
  return out;
}

std::vector<RobotPlan> plans(const sim::Scenario& scenario) {
  std::vector<RobotPlan> out;
  for (const sim::OtherRobot& robot : scenario.robots) {
    out.push_back({.pipeline = {.controller = scenario.controller, .by_hand = false},
                   .first = {(*robot.goals)[0]}});
  }
  return out;
}

void expect_the_same_on_any_threads(sim::PhysicsKind physics) {
  const RunSpec spec = make_spec(swap(physics), {});
  const std::vector<double> expected = numbers(spec, *make_robot(spec));
  EXPECT_EQ(numbers(spec, *make_robot(spec)), expected);
  for (const std::size_t threads : {2U, 4U}) {
    FleetRobot robot(spec.scenario,
                     spec.seed,
                     plans(spec.scenario),
                     [threads](std::size_t count, const std::function<void(std::size_t)>& call) {
                       std::atomic<std::size_t> next{0};
                       std::vector<std::jthread> crew;
                       for (std::size_t i = 0; i < threads; ++i) {
                         crew.emplace_back([&] {
                           for (std::size_t k = next++; k < count; k = next++) call(k);
                         });
                       }
                     });
    EXPECT_EQ(numbers(spec, robot), expected) << threads << " threads";
    EXPECT_EQ(numbers(spec, robot), expected) << threads << " threads, again after a reset";
  }
  RunSpec other = spec;
  other.seed = 2;
  EXPECT_NE(numbers(other, *make_robot(other)), expected);
}

TEST(FleetRobot, TheSameSpecGivesTheSameRunOnAnyNumberOfThreads) {
  expect_the_same_on_any_threads(sim::PhysicsKind::Kinematic);
}

TEST(FleetRobot, SoItDoesWithFullPhysics) {
  expect_the_same_on_any_threads(sim::PhysicsKind::Bullet);
}

TEST(FleetRobot, OverridesOfControllerAndParametersReachTheOthers) {
  sim::Scenario scenario = swap(sim::PhysicsKind::Kinematic);
  scenario.robots[1].controller = "original";
  scenario.robots[2].parameters = {{algo::find_parameter("v_max"), 0.1}};
  RunOverrides overrides;
  overrides.parameters = {{"v_max", 0.3}};
  const RunSpec spec = make_spec(scenario, overrides);
  const auto robot = make_robot(spec);
  const auto* fleet = dynamic_cast<const FleetRobot*>(robot.get());
  double fastest = 0;
  double slow = 0;
  drive(spec, *robot, 4, [&](const algo::Telemetry&) {
    fastest = std::max(fastest, fleet->telemetry(1).command.base.v);
    slow = std::max(slow, fleet->telemetry(3).command.base.v);
  });
  EXPECT_GT(fastest, 0.2);
  EXPECT_LE(fastest, 0.3);
  EXPECT_GT(slow, 0.05);
  EXPECT_LE(slow, 0.1);
}

TEST(FleetRobot, EditsReachTheOthersAndRobotsRefuseThem) {
  const RunSpec spec = make_spec(swap(sim::PhysicsKind::Kinematic), {});
  const auto robot = make_robot(spec);
  algo::Observation seen;
  robot->reset(seen);
  algo::Editing& editing = *robot->editing();
  EXPECT_EQ(editing.edit(algo::MoveObstacle{sim::kRobotIds + 3, {9, 9, 0}}),
            "Robot 3 moves by itself.");
  algo::Obstacle post{.id = 4, .pose_W = {0, 6.2, 0}, .shape = algo::Cylinder{0.1}};
  EXPECT_EQ(editing.edit(algo::AddObstacle{post}),
            "Robot 3: Obstacle 4 would overlap the robot: 0.25 m too close.");
  post.pose_W = {0, 5, 0};
  EXPECT_EQ(editing.edit(algo::AddObstacle{post}), std::nullopt);
  robot->step({}, seen);
  const auto* fleet = dynamic_cast<const FleetRobot*>(robot.get());
  EXPECT_NEAR(fleet->fleet().robot(2).ground_truth()->obstacle_distance, 0.9, 1e-6);
  EXPECT_EQ(editing.edit(algo::RemoveObstacle{4}), std::nullopt);
}

TEST(FleetRobot, RefusesScenariosWhoseRobotsOverlap) {
  sim::Scenario scenario = swap(sim::PhysicsKind::Kinematic);
  scenario.robots[3].start = {0.2, 6.1, 0};
  try {
    make_robot(make_spec(scenario, {}));
    FAIL() << "made";
  } catch (const std::invalid_argument& e) {
    EXPECT_STREQ(e.what(), "Robot 3 and Robot 5 overlap where they start.");
  }
}

/// Without manual driving, a robot's commands stay the same.
TEST(FleetRobot, WithoutAStickAPipelineCommandsTheSame) {
  const RunSpec spec = make_spec(ScenarioLibrary({}, {}).load("case2"), {});
  sim::World world(spec.scenario, 1);
  algo::PipelineConfig config = pipeline_config(spec);
  algo::Pipeline with(config, world.spec());
  config.by_hand = false;
  algo::Pipeline without(config, world.spec());
  algo::Telemetry a;
  algo::Telemetry b;
  world.reset(a.observation);
  for (algo::Pipeline* pipeline : {&with, &without}) pipeline->reset(a.observation.odometry.pose);
  for (const algo::Request& request : first_requests(spec)) a.requests.push_back(request);
  for (int tick = 0; tick < 800; ++tick) {
    b.observation = a.observation;
    b.requests = a.requests;
    with.tick(a);
    without.tick(b);
    ASSERT_EQ(a.command, b.command) << tick;
    a.requests.clear();
    world.step(a.command, a.observation);
  }
  EXPECT_EQ(without.refusal(algo::Joystick{0.5, 0}),
            "This robot drives by itself; it has no stick.");
  EXPECT_EQ(with.refusal(algo::Joystick{0.5, 0}), std::nullopt);
}

}  // namespace
}  // namespace server
