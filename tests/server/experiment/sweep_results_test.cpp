// tests/server/experiment/sweep_results_test.cpp: tests over scenarios and the order of
// controllers, from runs written by hand.
#include "server/experiment/sweep/sweep_results.hpp"

#include <string>

#include "tests/server/experiment/statistics_golden.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/experiment/sweep/sweep_report.hpp"

namespace server::sweep {
namespace {

using algo::Outcome;
using experiment::Row;
using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

Plan plan_of(std::size_t scenarios, std::size_t repeats) {
  json document = {{"name", "hand"},
                   {"controllers", {"original", "strip"}},
                   {"repeats", repeats},
                   {"time_limit", 100},
                   {"comparisons", {{"baseline", "original"}}}};
  for (std::size_t i = 0; i < scenarios; ++i) {
    document["scenarios"].push_back(
        {{"name", "s" + std::to_string(i)}, {"goal", {{"x", 4}, {"y", 0}}}});
  }
  return Plan(document_from_json(document, ScenarioLibrary("", "")));
}

Row run(bool reached, double time, double clearance = 0.5) {
  return {.outcome = reached ? Outcome::Reached : Outcome::Stuck,
          .figures = {{"time_s", time}, {"min_clearance_m", clearance}}};
}

/// The runs of a golden table of scenarios x seeds.
Rows rows_of(const Plan& plan, const golden::Json& each) {
  Rows rows(plan.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const RunPlace at = plan.place(i);
    const golden::Json& arm = each.at(at.arm == 0 ? "baseline" : "other");
    rows.set(i,
             run(arm.at("reached")[at.scenario][at.repeat].get<int>() == 1,
                 arm.at("time")[at.scenario][at.repeat].get<double>()));
  }
  return rows;
}

void expect_test(const PairedTest& found, const golden::Json& expected) {
  EXPECT_FALSE(found.mcnemar.has_value());
  EXPECT_TRUE(experiment::close(found.signed_rank.w_plus, expected.at("w_plus")));
  EXPECT_TRUE(experiment::close(found.signed_rank.rank_biserial, expected.at("rank_biserial")));
  EXPECT_TRUE(experiment::close(found.p(), expected.at("p")));
}

TEST(SweepResults, TestsAreThoseOfScipyOverScenarioMeans) {
  const golden::Json& each = experiment::values().at("scenarios")[0];
  const Plan plan = plan_of(12, 4);
  const Pairing found = results_of(plan, rows_of(plan, each)).pairings.at(0);
  expect_test(found.reached, each.at("reached"));
  expect_test(found.time, each.at("time"));
  EXPECT_TRUE(experiment::close(found.reached.differences->mean, each.at("mean_reached")));
  EXPECT_TRUE(experiment::close(found.time.differences->mean, each.at("mean_time")));
  EXPECT_EQ(found.reached.pairs, 48U);
  EXPECT_EQ(found.reached.signed_rank.pairs, 12U);
}

TEST(SweepResults, MoreSeedsOfTheSameRunsAreNoMoreEvidence) {
  const auto p_with = [](std::size_t repeats) {
    const Plan plan = plan_of(6, repeats);
    Rows rows(plan.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const RunPlace at = plan.place(i);
      rows.set(i, run(at.arm == 1 || at.scenario > 3, 20.0 + static_cast<double>(at.scenario)));
    }
    return results_of(plan, rows).pairings.at(0).reached.p();
  };
  EXPECT_DOUBLE_EQ(p_with(2), 0.125);  // 4 scenarios of 6 differ, all one way: 2 / 2^4
  EXPECT_DOUBLE_EQ(p_with(50), 0.125);
}

TEST(SweepResults, McNemarIsKeptForOneSeedPerScenario) {
  const Plan plan = plan_of(6, 1);
  Rows rows(plan.size());
  for (std::size_t i = 0; i < rows.size(); ++i) rows.set(i, run(plan.place(i).arm == 1, 20));
  const Pairing found = results_of(plan, rows).pairings.at(0);
  ASSERT_TRUE(found.reached.mcnemar.has_value());
  EXPECT_EQ(found.reached.mcnemar->only_other, 6U);
  EXPECT_DOUBLE_EQ(found.reached.p(), 2.0 / 64);
  EXPECT_DOUBLE_EQ(found.reached.p_holm, 3 * 2.0 / 64);
}

TEST(SweepResults, OfOneScenarioEachPairIsAnObservation) {
  const Plan plan = plan_of(1, 6);
  Rows rows(plan.size());
  for (std::size_t i = 0; i < rows.size(); ++i) rows.set(i, run(plan.place(i).arm == 1, 20));
  const Results results = results_of(plan, rows);
  EXPECT_FALSE(results.pairings.at(0).over_scenarios);
  EXPECT_DOUBLE_EQ(results.pairings.at(0).reached.p(), 2.0 / 64);
  EXPECT_THAT(to_markdown(plan, results), HasSubstr("says nothing about other scenarios"));
}

TEST(SweepResults, PairsOfWhichARunIsMissingAreLeftOut) {
  const Plan plan = plan_of(3, 2);
  Rows rows(plan.size());
  for (std::size_t i = 0; i < rows.size(); ++i) rows.set(i, run(true, 20));
  rows.erase(0);
  rows.erase(1);  // all of the baseline in the first scenario
  const Pairing found = results_of(plan, rows).pairings.at(0);
  EXPECT_EQ(found.time.pairs, 4U);
  EXPECT_EQ(found.time.signed_rank.pairs, 2U);
}

TEST(SweepResults, AControllerMayDriveAPartOfTheScenariosAndSeeds) {
  json source = {{"name", "parts"},
                 {"scenarios", {"case1", "case2", "case3"}},
                 {"controllers",
                  {"original",
                   "modified",
                   {{"name", "vff"}, {"repeats", 1}},
                   {{"name", "strip"}, {"scenarios", {"case3", "case1"}}}}},
                 {"repeats", 2},
                 {"comparisons", {{"baseline", "original"}}}};
  const Plan plan(document_from_json(source, ScenarioLibrary("", "")));
  EXPECT_EQ(plan.document().runs(), 3U * 2 + 3 * 2 + 3 + 2 * 2);
  ASSERT_EQ(plan.size(), plan.document().runs());
  for (std::size_t i = 0; i < plan.size(); ++i) {
    EXPECT_EQ(plan.number(plan.place(i)), i);
    EXPECT_LT(plan.place(i).repeat, plan.repeats(plan.place(i).scenario, plan.place(i).arm));
  }
  EXPECT_EQ(plan.repeats(1, 3), 0U);  // strip in case2
  Rows rows(plan.size());
  for (std::size_t i = 0; i < rows.size(); ++i) rows.set(i, run(true, 20));
  const Results results = results_of(plan, rows);
  EXPECT_TRUE(results.complete());
  EXPECT_EQ(results.arms.at(2).runs, 3U);
  EXPECT_EQ(results.arms.at(3).runs, 4U);
  EXPECT_EQ(results.scenarios.size(), 11U);
  EXPECT_EQ(results.pairings.at(1).reached.pairs, 3U);  // vff
  EXPECT_EQ(results.pairings.at(2).reached.pairs, 4U);  // strip
  EXPECT_EQ(results.rankings.at(0).order.size(), 3U) << "strip drives other scenarios";
  EXPECT_THAT(
      to_markdown(plan, results),
      HasSubstr("Not all controllers drive the same runs: vff 1 of 2 seeds, strip 2 of 3 scen"));
}

const Ranking& reading(const Results& results, const std::string& name) {
  for (const Ranking& each : results.rankings) {
    if (each.reading == name) return each;
  }
  throw std::out_of_range(name);
}

TEST(Robustness, FindsAnOrderThatAShorterTimeOrMoreRoomWouldChange) {
  // The baseline reaches 3 of 4 in 40 s, 0.06 m from an obstacle; the other all, in 70 s.
  const Plan plan = plan_of(2, 2);
  Rows rows(plan.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows.set(i, plan.place(i).arm == 0 ? run(i != 0, 40, 0.06) : run(true, 70, 0.3));
  }
  const Results results = results_of(plan, rows);
  EXPECT_THAT(results.rankings.front().order, ElementsAre(1, 0));
  EXPECT_THAT(reading(results, "time limit x 0.5").order, ElementsAre(0, 1));
  EXPECT_FALSE(reading(results, "time limit x 0.5").holds());
  EXPECT_TRUE(reading(results, "time limit x 0.75").holds());
  EXPECT_EQ(reading(results, "clearance of 0.05 m or more").rates[0], 0.75);
  EXPECT_EQ(reading(results, "clearance of 0.10 m or more").rates[0], 0);
  EXPECT_FALSE(reading(results, "2nd, 4th, 6th ... seed").holds());  // all reach, and 40 s < 70 s
  EXPECT_TRUE(reading(results, "1st, 3rd, 5th ... scenario").holds());
  EXPECT_THAT(to_markdown(plan, results),
              HasSubstr("| time limit x 0.5 | changes | original (0.75) > strip (0.00) | 1 of 1"));
}

TEST(Robustness, ATieIsNoSwap) {
  const Plan plan = plan_of(2, 1);
  Rows rows(plan.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows.set(i, run(plan.place(i).arm == 0 || plan.place(i).scenario == 0, 20));
  }
  const Results results = results_of(plan, rows);
  EXPECT_TRUE(reading(results, "1st, 3rd, 5th ... scenario").holds());
  EXPECT_EQ(results.rankings.size(), 7U);  // one seed has no halves
}

}  // namespace
}  // namespace server::sweep
