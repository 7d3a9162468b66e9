// tests/server/lab/tune_test.cpp: a search is repeatable, spends its budget, and finds what is
// plainly better.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/lab/tune/tune_document.hpp"
#include "server/lab/tune/tune_run.hpp"

namespace server::tune {
namespace {

using experiment::Row;
using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

json scenario(const char* name, double x) {
  return {{"name", name}, {"goal", {{"x", x}, {"y", 0}}}};
}

json source() {
  return {{"name", "faster"},
          {"controller", "go_to_goal"},
          {"parameters", {{"v_max", {0.1, 0.4}}}},
          {"objective", {{"maximize", "reached"}, {"then minimize", "time_s"}}},
          {"training", {scenario("near", 1), scenario("far", 1.5)}},
          {"test", {scenario("other", 1.2)}},
          {"physics", "kinematic"},
          {"budget", 41}};
}

Document read(const json& document) {
  return document_from_json(document, ScenarioLibrary("", ""));
}

void expect_refusal(const char* field, const json& value, const char* words) {
  json changed = source();
  changed[field] = value;
  EXPECT_THAT([&] { read(changed); }, ThrowsMessage<DocumentError>(HasSubstr(words)));
}

TEST(Tune, SpendsItsBudgetAndPrefersTheFastest) {
  const Document document = read(source());
  const auto attempts = search(document, {.threads = 2});
  ASSERT_TRUE(attempts);
  EXPECT_EQ(attempts->size(), 20U);  // 41 runs / 2 scenarios
  for (const Attempt& each : *attempts) {
    EXPECT_GE(each.point.at("v_max"), 0.1);
    EXPECT_LE(each.point.at("v_max"), 0.4);
  }
  // The time is nearly distance / v_max, so that the best is close to the upper limit.
  EXPECT_GT(best_of(*attempts).point.at("v_max"), 0.35);
}

TEST(Tune, TheSameDocumentGivesTheSameSearchForAnyNumberOfWorkers) {
  const Document document = read(source());
  const std::string once = to_csv(document, *search(document, {.threads = 1}));
  EXPECT_EQ(to_csv(document, *search(document, {.threads = 3})), once);
  json other = source();
  other["seed"] = 2;
  EXPECT_NE(to_csv(document, *search(read(other), {.threads = 1})), once);
}

TEST(Tune, ASettingThatTheControllerRefusesIsTheWorst) {
  json document = source();  // the strip's step of 0.2 m must be below k_r x 1 m
  document["controller"] = "original";
  document["parameters"] = {{"k_r", {0.05, 0.9}}};
  const auto attempts = search(read(document), {.threads = 2});
  ASSERT_TRUE(attempts);
  std::size_t refused = 0;
  for (const Attempt& each : *attempts) {
    EXPECT_EQ(std::isinf(each.loss), each.point.at("k_r") < 0.2) << each.point.at("k_r");
    if (std::isinf(each.loss)) ++refused;
  }
  EXPECT_GT(refused, 0U);
  EXPECT_LT(refused, attempts->size());
}

TEST(Tune, AStopEndsIt) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_FALSE(search(read(source()), {.threads = 1, .stop = stop.get_token()}));
}

TEST(Tune, TheSecondGoalDecidesOnlyBetweenEqualRates) {
  const std::vector<Goal> goals{{.metric = "reached", .is_rate = true, .maximize = true},
                                {.metric = "time_s"}};
  const double slow = loss_of(goals, {0.50, 1e9}, 100);
  EXPECT_LT(loss_of(goals, {0.50, 10}, 100), loss_of(goals, {0.50, 20}, 100));
  EXPECT_LT(slow, loss_of(goals, {0.49, 0}, 100));
  EXPECT_LE(slow, loss_of(goals, {0.50, std::nan("")}, 100));
}

TEST(Tune, AFigureIsOfTheRunsThatReached) {
  const auto row = [](algo::Outcome outcome, double time) {
    return Row{.outcome = outcome, .figures = {{"time_s", time}}};
  };
  const std::vector<Row> rows{row(algo::Outcome::Reached, 10),
                              row(algo::Outcome::Reached, 20),
                              row(algo::Outcome::Stuck, 300),
                              row(algo::Outcome::Collided, 1)};
  const std::vector<Goal> goals{{.metric = "stuck", .is_rate = true}, {.metric = "time_s"}};
  EXPECT_THAT(values_of(goals, rows), ElementsAre(0.25, 15));
}

TEST(Tune, ComparesTunedAndUntunedOnTheTestScenariosOnly) {
  const json test = read(source()).test_of({{"v_max", 0.3}});
  EXPECT_EQ(test["scenarios"], source()["test"]);
  EXPECT_EQ(test["controllers"][1]["parameters"]["v_max"], 0.3);
  EXPECT_EQ(test["comparisons"]["baseline"], "untuned");
}

TEST(Tune, RefusesWhatCannotBeMeant) {
  expect_refusal(
      "test", json::array({scenario("far", 3)}), "test: 'far' is a training scenario too");
  expect_refusal(
      "test", json::array({scenario("named_anew", 1)}), "'named_anew' is a training scenario too");
  expect_refusal("budget", 11, "budget: must be at least 12: 6 settings of 2 training runs each");
  expect_refusal("parameters", {{"v_max", {0.4, 0.1}}}, "parameters/v_max");
  expect_refusal("objective", {{"maximize", "luck"}}, "objective/maximize: 'luck' is neither");
  expect_refusal("objective", json::object(), "or 'minimize' must be given");
  expect_refusal("objective",
                 {{"minimize", "time_s"}, {"then minimize", "path_m"}},
                 "objective/minimize: must be a rate");
}

}  // namespace
}  // namespace server::tune
