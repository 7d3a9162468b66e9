// tests/server/experiment/trial_test.cpp: a trial gives a row; many trials give the same rows for
// any distribution over threads and shards.
#include "server/experiment/trial.hpp"

#include <atomic>
#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/experiment/series.hpp"
#include "server/run/scenario_library.hpp"

namespace server::experiment {
namespace {

using algo::Outcome;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// 1 m to the goal, nothing in the way, a noisy scanner.
RunSpec short_run(std::uint64_t seed = 1) {
  sim::Scenario scenario;
  scenario.name = "short";
  scenario.physics = sim::PhysicsKind::Kinematic;
  scenario.controller = "modified";
  scenario.goal = algo::SetGoal{{1, 0}, std::nullopt};
  scenario.robot.sensors.lasers = {sim::LaserConfig::with_resolution(0.5)};
  algo::Obstacle post{.id = 1, .shape = algo::Cylinder{.radius = 0.1}};
  post.pose_W = {0.5, 0.9, 0};
  scenario.obstacles.push_back(post);
  RunOverrides overrides;
  overrides.seed = seed;
  return make_spec(scenario, overrides);
}

Trial short_trial(std::size_t i) {
  return {.name = fmt::format("short, seed {}", i + 1),
          .spec = short_run(i + 1),
          .judges = common_judges()};
}

bool same(const Row& a, const Row& b) {
  return a.outcome == b.outcome && a.reason == b.reason && a.figures == b.figures;
}

TEST(Trial, GivesTheOutcomeAndTheColumnsOfItsJudges) {
  Trial trial = short_trial(0);
  trial.keep_track = true;
  trial.time_ticks = true;
  const Row row = run_trial(trial);
  EXPECT_EQ(row.outcome, Outcome::Reached);
  EXPECT_NEAR(row["path_m"], 0.9, 0.1);
  EXPECT_NEAR(row["end_x_m"], 0.9, 0.1);
  EXPECT_NEAR(row.track_W.back().x(), row["end_x_m"], 1e-12);
  const double ticks = row["time_s"] / trial.spec.scenario.period + 1;
  EXPECT_NEAR(static_cast<double>(row.track_W.size()), ticks, 0.01);
  ASSERT_EQ(row.tick_us.size(), row.track_W.size());
  for (const float us : row.tick_us) EXPECT_GT(us, 0);
  EXPECT_THROW(row["beauty"], std::out_of_range);
  // Equal apart from clock and track.
  const Row plain = run_trial(short_trial(0));
  EXPECT_TRUE(same(plain, row));
  EXPECT_TRUE(plain.track_W.empty());
  EXPECT_TRUE(plain.tick_us.empty());
}

TEST(Trial, AJudgeMayEndTheRun) {
  Trial trial = short_trial(0);
  trial.judges = {{.name = "barn_score", .settings = {{"goal_radius", 0.5}}}, {.name = "place"}};
  EXPECT_GT(run_trial(trial)["end_x_m"], 0.8);  // it watches only
  trial.until = "barn_score";
  const Row row = run_trial(trial);
  EXPECT_EQ(row.outcome, Outcome::Reached);
  EXPECT_NEAR(row["end_x_m"], 0.5, 0.05);
}

TEST(Trial, UnknownJudgesAreReported) {
  Trial trial = short_trial(0);
  trial.judges = {{.name = "beauty"}};
  EXPECT_THAT([&] { run_trial(trial); },
              ThrowsMessage<std::invalid_argument>(HasSubstr(", standing")));
  trial.judges = {{.name = "standing", .settings = {{"goal_radius", 1}}}};
  EXPECT_THAT([&] { run_trial(trial); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("no setting 'goal_radius'")));
  trial.judges = {{.name = "standing"}};
  trial.until = "standing";
  EXPECT_THROW(run_trial(trial), std::invalid_argument);
}

TEST(Trials, AnyNumberOfThreadsGivesTheSameRowsInTheirOrder) {
  constexpr std::size_t kTrials = 7;
  const std::vector<Row> alone = run_trials(kTrials, short_trial, {.threads = 1});
  ASSERT_EQ(alone.size(), kTrials);
  EXPECT_NE(alone[0].figures, alone[1].figures);  // their seeds differ
  for (const unsigned threads : {2U, 3U, 8U}) {
    const std::vector<Row> together = run_trials(kTrials, short_trial, {.threads = threads});
    ASSERT_EQ(together.size(), kTrials);
    for (std::size_t i = 0; i < kTrials; ++i) EXPECT_TRUE(same(alone[i], together[i])) << i;
  }
}

TEST(Trials, ShardsInterleaveToTheWhole) {
  constexpr std::size_t kTrials = 8;
  const std::vector<Row> whole = run_trials(kTrials, short_trial, {});
  for (const std::size_t shards : {1U, 2U, 3U, 5U, 9U}) {
    std::size_t rows = 0;
    for (std::size_t index = 0; index < shards; ++index) {
      const Shard shard{.index = index, .count = shards};
      const std::vector<Row> part = run_trials(kTrials, short_trial, {.shard = shard});
      for (std::size_t k = 0; k < part.size(); ++k) {
        ASSERT_LT(shard.job(k), kTrials);
        EXPECT_TRUE(same(part[k], whole[shard.job(k)])) << index << "/" << shards << ", " << k;
      }
      rows += part.size();
    }
    EXPECT_EQ(rows, kTrials);
  }
}

TEST(Trials, AFailureNamesItsTrial) {
  const auto trial = [](std::size_t i) {
    Trial each = short_trial(i);
    // An obstacle stands at the start.
    if (i == 2) each.spec.scenario.obstacles.front().pose_W = {0, 0, 0};
    return each;
  };
  EXPECT_THAT([&] { run_trials(4, trial, {.threads = 2}); },
              ThrowsMessage<std::runtime_error>(HasSubstr("short, seed 3: Obstacle 1")));
}

TEST(Trials, TrialsSkippedByAStopAreMarkedStopped) {
  std::stop_source source;
  const auto trial = [&](std::size_t i) {
    if (i == 1) source.request_stop();
    return short_trial(i);
  };
  const std::vector<Row> rows = run_trials(4, trial, {.threads = 1, .stop = source.get_token()});
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows[0].outcome, Outcome::Reached);
  for (std::size_t i = 1; i < 4; ++i) EXPECT_EQ(rows[i].outcome, Outcome::Stopped) << i;
}

// ---- series ------------------------------------------------------------------------------------

TEST(Series, RunsItsSeedsAndKeepsTheTrackOfTheFirst) {
  const std::vector<SeriesPlan> plans{{"short", "modified", short_run(1), 2},
                                      {"short", "again", short_run(2), 1}};
  const std::vector<Series> all = run_series(plans, common_judges(), {});
  ASSERT_EQ(all.size(), 2U);
  ASSERT_EQ(all[0].runs.size(), 2U);
  EXPECT_FALSE(all[0].runs[0].track_W.empty());
  EXPECT_TRUE(all[0].runs[1].track_W.empty());
  EXPECT_EQ(all[0].runs[1].figures, all[1].runs[0].figures);  // seed 2 is seed 2
  EXPECT_EQ(find_series(all, "short", "again"), &all[1]);
  EXPECT_EQ(find_series(all, "long", "again"), nullptr);
  EXPECT_THROW(run_series(plans, {}, {.shard = {.index = 0, .count = 2}}), std::invalid_argument);
}

Series two_runs() {
  const auto run = [](Outcome outcome, double time, double clearance, double depth) {
    return Row{.outcome = outcome,
               .figures = {{"time_s", time},
                           {"min_clearance_m", clearance},
                           {"safety_depth_m", depth},
                           {"silent", 1.0}}};
  };
  return {"case1",
          "modified",
          {run(Outcome::Reached, 10, 0.70, 0.01), run(Outcome::Stuck, 20, 0.60, 0.05)}};
}

TEST(Series, ColumnsSelectMeanMaximumOrMinimum) {
  const Series series = two_runs();
  EXPECT_DOUBLE_EQ(figure(series, "time_s"), 15);
  EXPECT_DOUBLE_EQ(figure(series, "min_clearance_m"), 0.6);
  EXPECT_DOUBLE_EQ(figure(series, "safety_depth_m"), 0.05);
  EXPECT_DOUBLE_EQ(figure(series, "silent"), 2);
  EXPECT_DOUBLE_EQ(figure(series, "reached"), 1);
  EXPECT_DOUBLE_EQ(figure(series, "runs"), 2);
  EXPECT_EQ(outcomes_text(series), "1 reached, 1 stuck");
  EXPECT_EQ(outcome_letters(series), "r1 s1");
  EXPECT_FALSE(common_outcome(series));
  EXPECT_FALSE(all_reach(series));
  // "Holds for every seed": an upper limit is held against the largest clearance.
  EXPECT_DOUBLE_EQ(figure_against(series, "min_clearance_m", false), 0.7);
  EXPECT_DOUBLE_EQ(figure_against(series, "min_clearance_m", true), 0.6);
  EXPECT_DOUBLE_EQ(figure_against(series, "time_s", false), 15);
  EXPECT_TRUE(is_figure("collided"));
  EXPECT_TRUE(is_figure("barn_score"));
  EXPECT_FALSE(is_figure("beauty"));
  EXPECT_THROW(figure(series, "path_m"), std::out_of_range);
}

TEST(Series, NonFiniteNumbersAreNullInJson) {
  Series series = two_runs();
  for (Row& run : series.runs) run.figures[1].second = std::numeric_limits<double>::infinity();
  const nlohmann::json json = figures_json(series);
  EXPECT_EQ(json["stuck"], 1);
  EXPECT_EQ(json["time_s"], 15);
  EXPECT_TRUE(json["min_clearance_m"].is_null());
}

}  // namespace
}  // namespace server::experiment
