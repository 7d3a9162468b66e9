// tests/server/experiment/statistics_test.cpp: statistics against values of scipy and numpy
// (tests/golden/statistics.py).
#include "server/experiment/statistics.hpp"

#include <algorithm>
#include <cmath>

#include "tests/server/experiment/statistics_golden.hpp"
#include <gtest/gtest.h>

namespace server::experiment {
namespace {

TEST(Statistics, QuantilesAreThoseOfNumpy) {
  for (const golden::Json& each : values().at("quantiles")) {
    const std::vector<double> sorted = golden::numbers(each.at("sorted"));
    for (std::size_t i = 0; i < each.at("p").size(); ++i) {
      EXPECT_TRUE(close(quantile(sorted, each.at("p")[i].get<double>()), each.at("q")[i]));
    }
  }
}

TEST(Statistics, AQuantileOfValuesInAnyOrderIsThatOfTheSorted) {
  EXPECT_EQ(quantile_of({4, 1, 3, 2}, 0.5), 2.5);
  EXPECT_EQ(quantile_of({4, 1, 3, 2}, 1), 4);
  EXPECT_TRUE(std::isnan(quantile_of({}, 0.5)));
}

TEST(Statistics, TheIntervalOfAMeanIsThatOfScipyFromTheSameResamples) {
  for (const golden::Json& each : values().at("bca")) {
    const Interval found =
        bca_interval(golden::numbers(each.at("values")), golden::numbers(each.at("means")));
    EXPECT_TRUE(close(found.low, each.at("low")));
    EXPECT_TRUE(close(found.high, each.at("high")));
  }
}

TEST(Statistics, TheIntervalOfARateIsThatOfScipy) {
  for (const golden::Json& each : values().at("wilson")) {
    const Interval found =
        wilson_interval(each.at("count").get<std::size_t>(), each.at("n").get<std::size_t>());
    EXPECT_TRUE(close(found.low, each.at("low")));
    EXPECT_TRUE(close(found.high, each.at("high")));
  }
}

TEST(Statistics, OwnResamplesGiveNearlyTheIntervalOfScipy) {
  const golden::Json& each = values().at("bca")[1];
  const std::vector<double> all = golden::numbers(each.at("values"));
  const Summary summary = summarise(all).value();
  const double width = each.at("high").get<double>() - each.at("low").get<double>();
  EXPECT_NEAR(summary.mean_interval.value().low, each.at("low").get<double>(), 0.1 * width);
  EXPECT_NEAR(summary.mean_interval.value().high, each.at("high").get<double>(), 0.1 * width);
}

TEST(Statistics, TheOrderOfTheValuesDoesNotMatter) {
  std::vector<double> all = golden::numbers(values().at("bca")[1].at("values"));
  const Summary one = summarise(all).value();
  std::ranges::reverse(all);
  const Summary two = summarise(all).value();
  EXPECT_EQ(one.mean, two.mean);
  EXPECT_EQ(one.mean_interval.value().low, two.mean_interval.value().low);
  EXPECT_EQ(one.mean_interval.value().high, two.mean_interval.value().high);
}

TEST(Statistics, AFewValuesAreSummarisedToo) {
  EXPECT_FALSE(summarise({}).has_value());
  const Summary one = summarise({3.0}).value();
  EXPECT_EQ(one.median, 3.0);
  EXPECT_FALSE(one.mean_interval.has_value());
  const Summary same = summarise({3.0, 3.0, 3.0}).value();
  EXPECT_EQ(same.mean_interval.value().low, 3.0);
  EXPECT_EQ(same.mean_interval.value().high, 3.0);
}

}  // namespace
}  // namespace server::experiment
