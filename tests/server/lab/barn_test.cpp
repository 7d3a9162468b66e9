// tests/server/lab/barn_test.cpp: worlds read and refused, runs scored by the official formula.
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "algo/driving.hpp"
#include "algo/strip/strip_law.hpp"
#include "server/lab/barn/barn_run.hpp"
#include "server/run/json_reader.hpp"
#include "server/run/scenario_json.hpp"

namespace server::barn {
namespace {

using algo::Outcome;
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
  EXPECT_FALSE(algo::any_moves(still.obstacles));
  const World moving = worlds_from_json(crossing()).at(0);
  const auto mover =
      std::ranges::find_if(moving.obstacles, [](const auto& o) { return o.path.has_value(); });
  ASSERT_NE(mover, moving.obstacles.end());
  EXPECT_EQ(mover->path->at(5), algo::Vec2(4, 0));
}

TEST(BarnFile, NamesTheErrorAndItsPlace) {
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
  try {
    read_worlds("/dev/null");
    ADD_FAILURE() << "an empty file is no JSON";
  } catch (const std::runtime_error& e) {
    EXPECT_THAT(e.what(), ::testing::HasSubstr("/dev/null: bad JSON at line 1, column 1"));
  }
}

TEST(BarnFile, WorldsAreChosenByNumberAndOneThatIsNotThereIsNamed) {
  const std::vector<World> worlds{worlds_from_json(crossing()).at(0),
                                  worlds_from_json(lane()).at(0)};
  const std::vector<World> chosen = worlds_numbered(worlds, {7});
  ASSERT_EQ(chosen.size(), 1U);
  EXPECT_EQ(chosen.front().id, 7U);
  EXPECT_EQ(worlds_numbered(worlds, {7, 8}).front().id, 8U);
  try {
    worlds_numbered(worlds, {7, 9});
    FAIL() << "world 9 is not there";
  } catch (const std::runtime_error& e) {
    EXPECT_STREQ(e.what(), "no world of the file has the number 9");
  }
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
  EXPECT_FALSE(flat.robot.sensors.lasers.front().rolling);
  const sim::Scenario sweeping = scenario_of(world, {.scanner = Scanner::Lms200});
  EXPECT_TRUE(sweeping.robot.sensors.lasers.front().rolling);
  EXPECT_DOUBLE_EQ(sweeping.robot.sensors.lasers.front().range_max, 8.191);
}

TEST(BarnRun, ScoresByTheOfficialFormula) {
  const auto worlds = worlds_from_json(lane());
  Options options;
  options.conditions.physics = sim::PhysicsKind::Kinematic;
  options.repeats = 2;
  options.pool.threads = 2;
  const Result result = run_worlds(worlds, options);
  ASSERT_EQ(result.runs.size(), 2U);
  for (const auto& run : result.runs) {
    EXPECT_EQ(run.row.outcome, Outcome::Reached);
    const double optimal = 6.0 / 2;
    const double time = run.row["barn_time_s"];
    const double score = run.row["barn_score"];
    const double quarter = run.row["barn_score_quarter"];
    EXPECT_DOUBLE_EQ(score, optimal / std::clamp(time, 2 * optimal, 8 * optimal));
    EXPECT_DOUBLE_EQ(quarter, optimal / std::clamp(time, 4 * optimal, 8 * optimal));
    EXPECT_NEAR(run.row["path_m"], 5, 0.3);  // to 1 m before the goal
  }
  const Summary sum = summarise(result);
  EXPECT_EQ(sum.rates.success, 1);
  EXPECT_EQ(sum.worlds, 1U);
  EXPECT_EQ(sum.rates.runs, 2U);
  EXPECT_GT(sum.tick_us_p99, 0);
}

TEST(BarnRun, NamesItsParametersAndTakesOthers) {
  Options options;
  options.conditions.physics = sim::PhysicsKind::Kinematic;
  const auto worlds = worlds_from_json(lane());
  const Result as_benchmarked = run_worlds(worlds, options);
  EXPECT_EQ(as_benchmarked.parameters[algo::kContractionGain], 0.4);
  EXPECT_EQ(as_benchmarked.parameters[algo::kSafetyDistance], 0.75);
  options.conditions.parameters = {{"v_max", 0.5}, {"k_c", 0.8}};
  const Result slower = run_worlds(worlds, options);
  EXPECT_EQ(slower.parameters[algo::kContractionGain], 0.8);
  EXPECT_GT(slower.runs[0].row["barn_time_s"], 2 * as_benchmarked.runs[0].row["barn_time_s"]);
  options.conditions.parameters = {{"no_such", 1}};
  EXPECT_THROW(run_worlds(worlds, options), DocumentError);
}

TEST(BarnRun, CountsTheRunsOfEachDifficulty) {
  Result result;
  EXPECT_TRUE(by_difficulty(result).empty());
  const auto ran = [&](const char* difficulty, Outcome outcome) {
    result.runs.push_back({.difficulty = difficulty, .row = {.outcome = outcome}});
  };
  ran("easy", Outcome::Reached);
  ran("hard", Outcome::Collided);
  ran("easy", Outcome::OutOfTime);
  ran("", Outcome::Reached);
  const std::vector<Bin> bins = by_difficulty(result);
  ASSERT_EQ(bins.size(), 2U);
  EXPECT_EQ(bins[0].difficulty, "easy");
  EXPECT_EQ(bins[0].rates.runs, 2U);
  EXPECT_EQ(bins[0].rates.success, 0.5);
  EXPECT_EQ(bins[0].rates.timeouts, 0.5);
  EXPECT_EQ(bins[1].difficulty, "hard");
  EXPECT_EQ(bins[1].rates.collisions, 1);
}

/// Summing 600 times 1/600 once gave a rate above 1.
TEST(BarnRun, RatesAreFractionsOfOne) {
  Result result;
  result.runs.resize(600);
  for (auto& run : result.runs) {
    run.row = {.outcome = Outcome::Reached,
               .figures = {{"contact", 0.0},
                           {"barn_time_s", 1.0},
                           {"barn_score", 0.5},
                           {"barn_score_quarter", 0.25}}};
  }
  EXPECT_EQ(summarise(result).rates.success, 1);
}

TEST(BarnRun, ACollisionScoresNothing) {
  json document = lane();
  document["worlds"][0]["obstacles"] = {{0, 3}};
  Options options;
  options.conditions.controller = "go_to_goal";
  options.conditions.physics = sim::PhysicsKind::Kinematic;
  const Result result = run_worlds(worlds_from_json(document), options);
  EXPECT_EQ(result.runs[0].row.outcome, Outcome::Collided);
  EXPECT_EQ(result.runs[0].row["barn_score"], 0);
  EXPECT_EQ(summarise(result).rates.collisions, 1);
}

TEST(BarnRun, TheSameSeedGivesTheSameRunWhateverTheWorkers) {
  const auto worlds = worlds_from_json(lane());
  Options options;
  options.conditions.stress = true;
  options.repeats = 3;
  options.pool.threads = 1;
  const Result alone = run_worlds(worlds, options);
  options.pool.threads = 3;
  const Result together = run_worlds(worlds, options);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(alone.runs[i].row.figures, together.runs[i].row.figures);
  }
}

TEST(BarnRun, AShardHasItsOwnWorldsAndSeeds) {
  json document = lane();
  document["worlds"].push_back(document["worlds"][0]);
  document["worlds"][1]["id"] = 9;
  Options options;
  options.conditions.physics = sim::PhysicsKind::Kinematic;
  options.repeats = 2;
  options.pool.shard = {.index = 1, .count = 2};
  const Result result = run_worlds(worlds_from_json(document), options);
  ASSERT_EQ(result.runs.size(), 2U);
  EXPECT_EQ(result.runs[0].world, 7U);
  EXPECT_EQ(result.runs[1].world, 9U);
  for (const auto& run : result.runs) EXPECT_EQ(run.seed, 2U);
  const experiment::Table table = rows_table(result);
  EXPECT_EQ(table.rows[1][0], "9");
  EXPECT_EQ(table.rows[1][2], "reached");
}

/// The robot stands in the way of a moving obstacle, and the contact is judged with the others.
TEST(BarnRun, AContactWithAMovingObstacleIsJudgedWithHindsight) {
  json document = crossing();
  document["worlds"][0]["obstacles"][0]["keys"] = {{0, 8, 0}, {10, -8, 0}, {20, 8, 0}};
  Options options;
  options.conditions.controller = "go_to_goal";
  options.conditions.physics = sim::PhysicsKind::Kinematic;
  const Result result = run_worlds(worlds_from_json(document), options);
  EXPECT_EQ(result.runs[0].row.outcome, Outcome::Collided);
  EXPECT_EQ(result.runs[0].contact(), experiment::Contact::Avoidable);
  EXPECT_EQ(summarise(result).avoidable, 1U);
}

}  // namespace
}  // namespace server::barn
