// tests/algo/filter/causal_median_test.cpp: delay, prefill and refusals of the causal median.
#include "algo/filter/causal_median.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace {

TEST(CausalMedian, AStepIsDelayedByHalfAWindow) {
  for (const std::size_t window : {1U, 3U, 5U, 21U}) {
    algo::CausalMedian median(window);
    EXPECT_EQ(median.push(1).value(), 1);
    std::size_t late = 0;
    while (median.push(2).value() == 1) ++late;
    EXPECT_EQ(late, (window - 1) / 2);
  }
}

TEST(CausalMedian, ANonFiniteNumberDoesNotEnter) {
  algo::CausalMedian median(3);
  EXPECT_EQ(median.push(std::numeric_limits<double>::quiet_NaN()), std::nullopt);
  EXPECT_EQ(median.push(4).value(), 4);  // this is the first sample
  EXPECT_EQ(median.push(std::numeric_limits<double>::infinity()), std::nullopt);
  EXPECT_EQ(median.push(4).value(), 4);
  median.reset();
  EXPECT_EQ(median.push(9).value(), 9);
}

TEST(CausalMedian, LiteralIsBiasedHigh) {
  std::vector<double> values = {1, 2, 3, 4, 5};
  EXPECT_EQ(algo::descending_median(values, algo::MedianRank::Corrected), 3);
  EXPECT_EQ(algo::descending_median(values, algo::MedianRank::Literal), 4);
}

TEST(CausalMedian, NoWindowIsRefused) {
  EXPECT_THROW(algo::CausalMedian(0), std::invalid_argument);
  EXPECT_THROW(algo::descending_median({}, algo::MedianRank::Corrected), std::invalid_argument);
}

}  // namespace
