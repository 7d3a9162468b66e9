// tests/server/experiment/paired_tests_test.cpp: paired tests against values of scipy
// (tests/golden/statistics.py).
#include "server/experiment/paired_tests.hpp"

#include "tests/server/experiment/statistics_golden.hpp"
#include <gtest/gtest.h>

namespace server::experiment {
namespace {

TEST(PairedTests, McNemarIsTheBinomialTestOfScipy) {
  for (const golden::Json& each : values().at("mcnemar")) {
    std::vector<PairedOutcome> pairs(3, {true, true});  // pairs that agree say nothing
    pairs.insert(pairs.end(), each.at("only_baseline").get<std::size_t>(), {true, false});
    pairs.insert(pairs.end(), each.at("only_other").get<std::size_t>(), {false, true});
    const McNemar found = mcnemar(pairs);
    EXPECT_TRUE(close(found.p, each.at("p")));
    EXPECT_EQ(found.pairs, pairs.size());
    EXPECT_EQ(found.only_other, each.at("only_other").get<std::size_t>());
  }
}

TEST(PairedTests, WilcoxonIsThatOfScipyOrOfAllPatternsOfSigns) {
  for (const golden::Json& each : values().at("wilcoxon")) {
    SCOPED_TRACE(each.at("method").get<std::string>());
    const Wilcoxon found = wilcoxon(golden::numbers(each.at("differences")));
    EXPECT_TRUE(close(found.w_plus, each.at("w_plus")));
    EXPECT_TRUE(close(found.w_minus, each.at("w_minus")));
    EXPECT_TRUE(close(found.p, each.at("p")));
    EXPECT_TRUE(close(found.rank_biserial, each.at("rank_biserial")));
    EXPECT_EQ(found.exact, each.at("method") != "approx");
  }
}

TEST(PairedTests, WithoutADifferenceNothingIsFound) {
  const Wilcoxon found = wilcoxon(std::vector<double>{0.0, 0.0});
  EXPECT_EQ(found.pairs, 2U);
  EXPECT_EQ(found.nonzero, 0U);
  EXPECT_EQ(found.p, 1.0);
  EXPECT_EQ(found.rank_biserial, 0.0);
}

TEST(PairedTests, HolmKeepsTheOrderAndNeverFalls) {
  for (const golden::Json& each : values().at("holm")) {
    const std::vector<double> adjusted = holm(golden::numbers(each.at("p")));
    for (std::size_t i = 0; i < adjusted.size(); ++i) {
      EXPECT_TRUE(close(adjusted[i], each.at("adjusted")[i]));
    }
  }
}

}  // namespace
}  // namespace server::experiment
