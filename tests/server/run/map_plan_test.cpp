// tests/server/run/map_plan_test.cpp: a robot that plans by a known map, right or wrong.
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "tests/server/map_room.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/run/run_spec.hpp"
#include "server/run/runner.hpp"

namespace server {
namespace {

using algo::Vec2;
using See = std::function<void(const algo::Telemetry&)>;

algo::Obstacle wall(const Vec2& a, const Vec2& b) {
  const Vec2 way = b - a;
  const Vec2 middle = (a + b) / 2;
  algo::Obstacle piece;
  piece.shape = algo::Wall{way.norm(), 0.1};
  piece.pose_W = {middle.x(), middle.y(), std::atan2(way.y(), way.x())};
  return piece;
}

/// A room of 16 x 9 m with a corridor along its middle, from the robot's end to a goal behind it.
sim::Scenario corridor_in_a_room() {
  const auto document = nlohmann::json::parse(R"({
    "name": "corridor", "physics": "kinematic", "controller": "strip", "time_limit": 120,
    "lasers": [{"field_of_view_deg": 360, "beams": 720, "range_max": 8}],
    "start": {"x": 1.5, "y": 4.5, "heading": 0}, "goal": {"x": 14.5, "y": 4.5}})");
  sim::Scenario scenario = scenario_from_json(document);
  scenario.obstacles = {wall({0, 0}, {16, 0}),
                        wall({0, 9}, {16, 9}),
                        wall({0, 0}, {0, 9}),
                        wall({16, 0}, {16, 9}),
                        wall({4, 3}, {12, 3}),
                        wall({4, 6}, {12, 6})};
  return scenario;
}

void add(sim::Scenario& scenario, const algo::Obstacle& piece) {
  scenario.obstacles.push_back(piece);
}

/// Drives in `world` by a map of `drawn`.
RunResult plan_by(const sim::Scenario& drawn, sim::Scenario world, const See& see) {
  std::uint32_t id = 0;
  for (algo::Obstacle& piece : world.obstacles) piece.id = ++id;
  RunOverrides overrides;
  overrides.map = map_room::map_of(drawn);
  const RunSpec spec = make_spec(std::move(world), overrides);
  const auto robot = make_robot(spec);
  algo::Pipeline pipeline(pipeline_config(spec), robot->spec());
  const auto pool = FramePool::make(2);
  RunLinks links;
  links.pool = pool.get();
  links.listeners.push_back([&](const Frame& frame) { see(frame.telemetry); });
  const RunPolicy policy{.until_outcome = true, .time_limit = time_limit(spec)};
  return run(*robot, pipeline, first_requests(spec), policy, links, {});
}

TEST(MapPlan, KeepsOutOfADeadEndThatTheMapShows) {
  sim::Scenario world = corridor_in_a_room();
  add(world, wall({12, 3}, {12, 6}));
  double right = 0;  // [s]
  double wrong = 0;  // [s]
  bool entered = false;
  const RunResult by_map = plan_by(world, world, [&](const algo::Telemetry& t) {
    const Vec2 p = t.ground_truth->pose.position();
    entered = entered || (p.y() > 3 && p.y() < 6 && p.x() > 4.3 && p.x() < 12);
    right = t.observation.stamp;
  });
  EXPECT_EQ(by_map.outcome, algo::Outcome::Reached) << by_map.reason;
  EXPECT_FALSE(entered);
  // On a map without the wall it begins to enter, and then believes its own sight.
  const RunResult by_a_wrong_one = plan_by(
      corridor_in_a_room(), world, [&](const algo::Telemetry& t) { wrong = t.observation.stamp; });
  EXPECT_EQ(by_a_wrong_one.outcome, algo::Outcome::Reached) << by_a_wrong_one.reason;
  EXPECT_LT(right, wrong - 4);
}

TEST(MapPlan, ReachesAGoalBehindADrawnWallThatIsGone) {
  sim::Scenario world = corridor_in_a_room();
  for (const double y : {0.0, 6.0}) add(world, wall({4, y}, {4, y + 3}));
  sim::Scenario drawn = world;
  add(drawn, wall({12, 3}, {12, 6}));
  double told = -1;  // [s]
  const RunResult result = plan_by(drawn, world, [&](const algo::Telemetry& t) {
    const bool says = t.words.why.find("The known map shows no way") != std::string::npos;
    if (told < 0 && says) told = t.observation.stamp;
  });
  EXPECT_EQ(result.outcome, algo::Outcome::Reached) << result.reason;
  EXPECT_GE(told, 0);
  EXPECT_LT(told, 5);
}

TEST(MapPlan, SaysSoonThatTheMapShowsSomethingOnTheGoal) {
  const sim::Scenario world = corridor_in_a_room();
  sim::Scenario drawn = world;
  algo::Obstacle block;
  block.shape = algo::Box{1.5, 1.5};
  block.pose_W = {14.5, 4.5, 0};
  add(drawn, block);
  double told = -1;  // [s]
  const See see = [&](const algo::Telemetry& t) {
    const bool says = t.words.why.find("shows something on the goal") != std::string::npos;
    if (told < 0 && says) told = t.observation.stamp;
  };
  const RunResult gone = plan_by(drawn, world, see);
  EXPECT_EQ(gone.outcome, algo::Outcome::Reached) << gone.reason;
  EXPECT_GE(told, 0);
  EXPECT_LT(told, 3);
}

}  // namespace
}  // namespace server
