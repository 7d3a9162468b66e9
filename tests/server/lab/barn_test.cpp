// tests/server/lab/barn_test.cpp: worlds read and refused, runs scored by the official formula.
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "server/lab/barn/barn_run.hpp"
#include "server/run/json_reader.hpp"
#include "server/run/scenario_json.hpp"

namespace server::barn {
namespace {

using nlohmann::json;

json lane() {
  return {{"worlds",
           {{{"id", 7},
             {"start", {0, 0, 1.57}},
             {"goal", {0, 6}},
             {"goal_radius", 1.0},
             {"radius", 0.075},
             {"optimal_path_length", 6.0},
             {"obstacles", {{-1.5, 3}, {1.5, 3}}}}}}};
}

json crossing() {
  return {
      {"worlds",
       {{{"id", 8},
         {"difficulty", "easy"},
         {"start", {0, 0, 0}},
         {"goal", {8, 0}},
         {"optimal_path_length", 8.0},
         {"obstacles",
          {{{"radius", 0.5}, {"period", 20}, {"keys", {{0, 4, 8}, {10, 4, -8}, {20, 4, 8}}}}}}}}}};
}

std::string complaint(const json& document) {
  try {
    worlds_from_json(document);
  } catch (const DocumentError& e) {
    return e.what();
  }
  return "";
}

TEST(BarnFile, ReadsPostsAndMovingCylinders) {
  const World still = worlds_from_json(lane()).at(0);
  EXPECT_EQ(still.id, 7U);
  EXPECT_EQ(still.obstacles.size(), 2U);
  EXPECT_TRUE(still.paths.empty());
  const World moving = worlds_from_json(crossing()).at(0);
  ASSERT_EQ(moving.paths.size(), 1U);
  EXPECT_EQ(moving.paths[0].at(5), algo::Vec2(4, 0));
  EXPECT_EQ(moving.difficulty, "easy");
}

TEST(BarnFile, SaysWhatIsWrongAndWhere) {
  json document = lane();
  document["worlds"][0]["goal"] = {1, "two"};
  EXPECT_EQ(complaint(document).substr(0, 15), "worlds/0/goal/1");
  document = lane();
  document["worlds"][0].erase("optimal_path_length");
  EXPECT_NE(complaint(document).find("worlds/0/optimal_path_length"), std::string::npos);
  document = lane();
  document["worlds"][0]["obstacles"][1] = {1};
  EXPECT_NE(complaint(document).find("worlds/0/obstacles/1"), std::string::npos);
  document = crossing();
  document["worlds"][0]["obstacles"][0]["keys"] = {{1, 0, 0}, {1, 0, 1}};
  EXPECT_NE(complaint(document).find("later"), std::string::npos);
  EXPECT_NE(complaint(json::object()), "");
  EXPECT_NE(complaint({{"worlds", json::array()}}), "");
  EXPECT_THROW(read_worlds("/nowhere/worlds.json"), std::runtime_error);
}

TEST(BarnFile, ItsScenariosComeBackFromTheirDocuments) {
  for (const json& document : {lane(), crossing()}) {
    for (const bool stress : {false, true}) {
      const World world = worlds_from_json(document).at(0);
      const sim::Scenario scenario = scenario_of(world, {.stress = stress, .phase = 2});
      const json written = to_json(scenario);
      EXPECT_EQ(to_json(scenario_from_json(written)), written);
    }
  }
}

TEST(BarnFile, TheScannerMayBeOneThatSweeps) {
  const World world = worlds_from_json(lane()).at(0);
  const sim::Scenario flat = scenario_of(world, {});
  EXPECT_FALSE(flat.lasers.front().rolling);
  const sim::Scenario sweeping = scenario_of(world, {.scanner = Scanner::Lms200});
  EXPECT_TRUE(sweeping.lasers.front().rolling);
  EXPECT_DOUBLE_EQ(sweeping.lasers.front().range_max, 8.191);
}

TEST(BarnRun, ScoresByTheOfficialFormula) {
  const auto worlds = worlds_from_json(lane());
  Options options;
  options.conditions.vehicle = sim::Vehicle::Kinematic;
  options.repeats = 2;
  options.workers = 2;
  const Result result = run_worlds(worlds, options);
  ASSERT_EQ(result.runs.size(), 2U);
  for (const auto& run : result.runs) {
    EXPECT_EQ(run.ending, Ending::Success);
    const double optimal = 6.0 / 2;
    EXPECT_DOUBLE_EQ(run.score, optimal / std::clamp(run.time, 2 * optimal, 8 * optimal));
    EXPECT_DOUBLE_EQ(run.score_quarter, optimal / std::clamp(run.time, 4 * optimal, 8 * optimal));
    EXPECT_NEAR(run.path_length, 5, 0.3);  // to 1 m before the goal
  }
  const Summary sum = summarise(result);
  EXPECT_EQ(sum.success, 1);
  EXPECT_EQ(sum.worlds, 1U);
  EXPECT_EQ(sum.runs, 2U);
  EXPECT_GT(sum.tick_us_p99, 0);
}

/// 600 successes summed up as sixhundredths once came to more than 1.
TEST(BarnRun, RatesAreFractionsOfOne) {
  Result result;
  result.runs.resize(600);
  for (auto& run : result.runs) run.ending = Ending::Success;
  EXPECT_EQ(summarise(result).success, 1);
}

TEST(BarnRun, ACollisionScoresNothing) {
  json document = lane();
  document["worlds"][0]["obstacles"] = {{0, 3}};
  Options options;
  options.conditions.controller = "go_to_goal";
  options.conditions.vehicle = sim::Vehicle::Kinematic;
  const Result result = run_worlds(worlds_from_json(document), options);
  EXPECT_EQ(result.runs[0].ending, Ending::Collision);
  EXPECT_EQ(result.runs[0].score, 0);
  EXPECT_EQ(summarise(result).collisions, 1);
}

TEST(BarnRun, TheSameSeedGivesTheSameRunWhateverTheWorkers) {
  const auto worlds = worlds_from_json(lane());
  Options options;
  options.conditions.stress = true;
  options.repeats = 3;
  options.workers = 1;
  const Result alone = run_worlds(worlds, options);
  options.workers = 3;
  const Result together = run_worlds(worlds, options);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(alone.runs[i].time, together.runs[i].time);
    EXPECT_EQ(alone.runs[i].end, together.runs[i].end);
  }
}

/// A cylinder that comes at 1 m/s towards the origin, where the robot stands or drives.
sim::Scenario oncoming() {
  sim::Scenario scenario = scenario_of(worlds_from_json(crossing()).at(0), {});
  scenario.paths[0].keys = {{0, {10, 0}}, {20, {-10, 0}}};
  return scenario;
}

TEST(Oracle, WhoStandsInTheWayCouldHaveDrivenOn) {
  const algo::RobotSpec spec{.radius = 0.35,
                             .max_v = 1,
                             .max_omega = 2,
                             .max_acceleration = 2,
                             .max_angular_acceleration = 4};
  std::vector<Moment> trail;
  for (int k = 0; k <= 60; ++k) trail.push_back({6.15 + 0.05 * k, {0, 0, 1.57}, {}});
  EXPECT_EQ(judge_contact(oncoming(), spec, trail), Contact::Avoidable);
  // Who can hardly move could not.
  algo::RobotSpec lame = spec;
  lame.max_v = lame.max_omega = 0.01;
  EXPECT_EQ(judge_contact(oncoming(), lame, trail), Contact::Unavoidable);
}

TEST(Oracle, AnObstacleThatJumpedIsNobodysFault) {
  const algo::RobotSpec spec{.radius = 0.35, .max_v = 1, .max_omega = 2, .max_acceleration = 2};
  std::vector<Moment> trail;
  for (int k = 0; k <= 60; ++k) trail.push_back({18.0 + 0.05 * k, {9.1, 0, 0}, {}});
  EXPECT_EQ(judge_contact(oncoming(), spec, trail), Contact::Jumped);
}

}  // namespace
}  // namespace server::barn
