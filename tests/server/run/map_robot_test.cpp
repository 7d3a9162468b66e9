// tests/server/run/map_robot_test.cpp: a robot with poor wheels that drives by its pose on a map.
#include "server/run/map_robot.hpp"

#include <cmath>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "tests/server/map_room.hpp"
#include "tests/temporary_folder.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/run/json_reader.hpp"
#include "server/run/map_file.hpp"
#include "server/run/run_spec.hpp"
#include "server/run/runner.hpp"

namespace server {
namespace {

using map_room::poor_wheels_in_a_room;
using map_room::spec_of;

using See = std::function<void(const algo::Telemetry&)>;

RunResult drive_by(const RunSpec& spec, algo::Robot& robot, const See& see) {
  algo::Pipeline pipeline(pipeline_config(spec), robot.spec());
  const auto pool = FramePool::make(2);
  RunLinks links;
  links.pool = pool.get();
  links.listeners.push_back([&](const Frame& frame) { see(frame.telemetry); });
  const RunPolicy policy{.until_outcome = true, .time_limit = time_limit(spec)};
  return run(robot, pipeline, first_requests(spec), policy, links, {});
}

/// [m] from the robot's true place to the goal, at the end.
double true_distance(const RunSpec& spec, const algo::Robot& robot) {
  return (robot.ground_truth()->pose.position() - spec.scenario.goal->position_W).norm();
}

TEST(MapRobot, ReachesItsGoalByTheMapWherePoorWheelsMissIt) {
  const sim::Scenario scenario = poor_wheels_in_a_room();
  const RunSpec blind = spec_of(scenario, false);
  const auto by_wheels = make_robot(blind);
  drive_by(blind, *by_wheels, [](const algo::Telemetry&) {});
  EXPECT_GT(true_distance(blind, *by_wheels), 0.5);

  const RunSpec spec = spec_of(scenario, true);
  const auto robot = make_robot(spec);
  double worst = 0;  // [m]
  const RunResult result = drive_by(spec, *robot, [&](const algo::Telemetry& t) {
    const auto& at = t.observation.map_pose;
    ASSERT_TRUE(at);
    if (!at->located()) return;
    const algo::Vec2 off = t.observation.odometry.pose.position() - t.ground_truth->pose.position();
    worst = std::max(worst, off.norm());
    EXPECT_LT(off.norm(), 5 * std::sqrt(at->xx + at->yy) + 0.02);
  });
  EXPECT_EQ(result.outcome, algo::Outcome::Reached) << result.reason;
  EXPECT_LT(true_distance(spec, *robot), 0.3);
  EXPECT_LT(worst, 0.12);
}

TEST(MapRobot, MayBeLostOnTheMapThatItsScenarioNames) {
  const tests::TemporaryFolder folder;
  algo::OccupancyMap cells(0.05);
  cells.mark_wall({1, 1});
  write_map(cells, folder.path() / "own.yaml");
  sim::Scenario scenario = poor_wheels_in_a_room();
  RunOverrides overrides;
  overrides.lost = true;
  EXPECT_THROW(make_spec(scenario, overrides), DocumentError);
  scenario.map = (folder.path() / "own.yaml").string();
  const RunSpec spec = make_spec(scenario, overrides);
  EXPECT_TRUE(spec.scenario.lost);
  EXPECT_TRUE(spec.map);
}

TEST(MapRobot, ARunThatEndsWithoutAPlaceSaysSo) {
  sim::Scenario scenario = poor_wheels_in_a_room();
  scenario.start.x += 300;  // where the map shows nothing
  scenario.time_limit = 5;
  const RunSpec spec = spec_of(scenario, true, true);
  const auto robot = make_robot(spec);
  const RunResult result = drive_by(spec, *robot, [](const algo::Telemetry&) {});
  EXPECT_EQ(result.outcome, algo::Outcome::OutOfTime);
  EXPECT_THAT(result.reason, testing::HasSubstr("fits nowhere on the map"));
}

TEST(MapRobot, ALostRobotIsHeldUntilItKnowsItsPlaceAndThenDrives) {
  const sim::Scenario scenario = poor_wheels_in_a_room();
  const RunSpec spec = spec_of(scenario, true, true);
  const auto robot = make_robot(spec);
  bool held = false;
  const RunResult result = drive_by(spec, *robot, [&](const algo::Telemetry& t) {
    if (t.observation.map_pose->located()) return;
    EXPECT_EQ(t.command.base, algo::Twist2{});
    held = held || t.hold == algo::holds::kNotLocated;
  });
  EXPECT_TRUE(held);
  EXPECT_EQ(result.outcome, algo::Outcome::Reached) << result.reason;
  EXPECT_LT(true_distance(spec, *robot), 0.3);
}

TEST(MapRobot, IsLookedForWhereSomebodySaysAndAnywhereElseAfterThat) {
  const sim::Scenario scenario = poor_wheels_in_a_room();
  const RunSpec spec = spec_of(scenario, true);
  const auto robot = make_robot(spec);
  ASSERT_NE(robot->locating(), nullptr);
  algo::Observation seen;
  robot->reset(seen);
  const auto wait = [&] {
    for (int k = 0; k < 2000 && !seen.map_pose->located(); ++k) robot->step({}, seen);
  };
  wait();
  ASSERT_TRUE(seen.map_pose->located());
  EXPECT_EQ(seen.map_pose->epoch, 1U);
  // A pose within 2 m and 0.5 rad is enough; a wrong one is found out.
  for (const algo::Pose2& told : {algo::Pose2{2.5, 2.2, 0.3}, algo::Pose2{12, 7, 2}}) {
    robot->locating()->place({told});
    robot->step({}, seen);
    EXPECT_FALSE(seen.map_pose->located());
    wait();
    ASSERT_TRUE(seen.map_pose->located());
    EXPECT_NEAR(seen.odometry.pose.x, 1.5, 0.05);
    EXPECT_NEAR(seen.odometry.pose.y, 1.5, 0.05);
  }
  EXPECT_EQ(seen.map_pose->epoch, 3U);
}

TEST(MapRobot, IsRepeatedBitForBit) {
  const RunSpec spec = spec_of(poor_wheels_in_a_room(), true, true);
  std::vector<std::vector<algo::Command>> runs;
  for (int k = 0; k < 2; ++k) {
    std::vector<algo::Command>& commands = runs.emplace_back();
    const auto robot = make_robot(spec);
    drive_by(spec, *robot, [&](const algo::Telemetry& t) { commands.push_back(t.command); });
  }
  EXPECT_GT(runs[0].size(), 100U);
  EXPECT_EQ(runs[0], runs[1]);
}

TEST(MapRobot, NeedsAScanner) {
  sim::Scenario scenario = poor_wheels_in_a_room();
  scenario.controller = "go_to_goal";
  const RunSpec spec = spec_of(scenario, true);
  RunSpec blind = spec;
  blind.scenario.robot.sensors.lasers.clear();
  blind.scenario.robot.sensors.sonar.emplace();
  EXPECT_THROW(make_robot(blind), std::exception);
}

}  // namespace
}  // namespace server
