// tests/server/experiment/clusters_test.cpp: intervals over scenarios, against values of scipy
// (tests/golden/statistics.py).
#include "server/experiment/clusters.hpp"

#include "tests/server/experiment/statistics_golden.hpp"
#include <gtest/gtest.h>

namespace server::experiment {
namespace {

std::vector<Cluster> clusters_of(const golden::Json& each) {
  std::vector<Cluster> all;
  for (std::size_t i = 0; i < each.at("sums").size(); ++i) {
    all.push_back({each.at("sums")[i].get<double>(), each.at("n")[i].get<double>()});
  }
  return all;
}

double width(const Interval& interval) {
  return interval.high - interval.low;
}

TEST(Clusters, TheIntervalIsThatOfScipyFromTheSameResamples) {
  for (const golden::Json& each : values().at("clusters")) {
    const Interval found = cluster_interval(clusters_of(each), golden::numbers(each.at("ratios")));
    EXPECT_TRUE(close(found.low, each.at("low")));
    EXPECT_TRUE(close(found.high, each.at("high")));
  }
}

TEST(Clusters, OwnResamplesGiveNearlyTheIntervalOfScipy) {
  const golden::Json& each = values().at("clusters")[0];
  const RateInterval found = rate_interval(clusters_of(each)).value();
  EXPECT_EQ(found.basis, Basis::Scenarios);
  EXPECT_NEAR(found.bounds.low, each.at("low").get<double>(), 0.05);
  EXPECT_NEAR(found.bounds.high, each.at("high").get<double>(), 0.05);
}

TEST(Clusters, RunsThatAgreeWithinAScenarioCountOnce) {
  std::vector<Cluster> clusters;  // 20 scenarios, 8 of them reached by all seeds, 12 by none
  for (int i = 0; i < 20; ++i) clusters.push_back({i < 8 ? 50.0 : 0.0, 50.0});
  const Interval over_scenarios = rate_interval(clusters).value().bounds;
  EXPECT_GT(width(over_scenarios), 5 * width(wilson_interval(400, 1000)));
  EXPECT_NEAR(width(over_scenarios), width(wilson_interval(8, 20)), 0.06);
}

TEST(Clusters, OneRunPerScenarioHasTheIntervalOfWilson) {
  const RateInterval found = rate_interval(std::vector<Cluster>{{1, 1}, {0, 1}, {1, 1}}).value();
  EXPECT_EQ(found.basis, Basis::Runs);
  EXPECT_DOUBLE_EQ(found.bounds.low, wilson_interval(2, 3).low);
}

TEST(Clusters, OneScenarioHasTheIntervalOfItsSeeds) {
  const RateInterval found = rate_interval(std::vector<Cluster>{{7, 10}}).value();
  EXPECT_EQ(found.basis, Basis::Seeds);
  EXPECT_DOUBLE_EQ(found.bounds.high, wilson_interval(7, 10).high);
}

TEST(Clusters, ARateThatIsTheSameEverywhereStillHasAnInterval) {
  const std::vector<Cluster> never(6, Cluster{0, 50});
  const RateInterval found = rate_interval(never).value();
  EXPECT_EQ(found.basis, Basis::Alike);
  EXPECT_EQ(found.bounds.low, 0);
  EXPECT_DOUBLE_EQ(found.bounds.high, wilson_interval(0, 6).high);
  EXPECT_FALSE(rate_interval({}).has_value());
}

TEST(Clusters, ASummaryHasTheQuantilesOfRunsAndTheIntervalOfScenarios) {
  const std::vector<std::vector<double>> times{{10, 10, 10, 10}, {20, 20, 20, 20}, {}, {30, 30}};
  const Summary found = summarise_clusters(times).value();
  EXPECT_EQ(found.n, 10U);
  EXPECT_EQ(found.mean, 18);
  EXPECT_EQ(found.median, 20);
  const Summary independent = summarise({10, 10, 10, 10, 20, 20, 20, 20, 30, 30}).value();
  EXPECT_GT(width(found.mean_interval.value()), width(independent.mean_interval.value()));
}

TEST(Clusters, ASummaryOfOneScenarioIsOverItsRuns) {
  const Summary found = summarise_clusters({{}, {1, 2, 4}}).value();
  EXPECT_EQ(found.mean_interval.value().low, summarise({1, 2, 4}).value().mean_interval->low);
  EXPECT_FALSE(summarise_clusters({{}, {}}).has_value());
}

}  // namespace
}  // namespace server::experiment
