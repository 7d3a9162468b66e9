// tests/sim/random_test.cpp: the generators' moments, tails and independence of purpose.
#include "sim/random.hpp"

#include <cmath>
#include <span>
#include <vector>

#include <gtest/gtest.h>

namespace sim {
namespace {

TEST(Random, SameSeedSameNumbersAndOneStreamPerPurpose) {
  Random a(7, 1);
  Random b(7, 1);
  Random other(7, 2);
  bool differs = false;
  for (int i = 0; i < 100; ++i) {
    const std::uint64_t x = a.bits();
    EXPECT_EQ(x, b.bits());
    differs = differs || x != other.bits();
  }
  EXPECT_TRUE(differs);
}

TEST(Random, NormalNumbersHaveTheMomentsAndTailsOfTheBellCurve) {
  constexpr std::size_t kCount = 1000000;
  std::vector<double> x(kCount);
  Random(3).fill_normal(x);
  double mean = 0;
  double square = 0;
  double fourth = 0;
  double within_one = 0;
  double beyond_two = 0;
  double beyond_tail = 0;  // past 3.4426, drawn by the tail method
  for (const double v : x) {
    mean += v;
    square += v * v;
    fourth += v * v * v * v;
    within_one += std::abs(v) < 1 ? 1 : 0;
    beyond_two += std::abs(v) > 2 ? 1 : 0;
    beyond_tail += std::abs(v) > 3.442619855899 ? 1 : 0;
  }
  // Standard errors for 1e6 draws: mean 0.001, square 0.0014, fourth 0.0098, shares < 0.0005.
  EXPECT_NEAR(mean / kCount, 0, 0.005);
  EXPECT_NEAR(square / kCount, 1, 0.007);
  EXPECT_NEAR(fourth / kCount, 3, 0.05);
  EXPECT_NEAR(within_one / kCount, 0.682689, 0.0025);
  EXPECT_NEAR(beyond_two / kCount, 0.045500, 0.0011);
  EXPECT_NEAR(beyond_tail / kCount, std::erfc(3.442619855899 / std::sqrt(2.0)), 1.2e-4);
}

TEST(Random, ARowHasTheNumbersDrawnOneByOne) {
  std::vector<double> row(1000);
  Random(4).fill_normal(row);
  Random alone(4);
  for (const double expected : row) {
    double value = 0;
    alone.fill_normal(std::span(&value, 1));
    EXPECT_EQ(value, expected);
  }
}

TEST(Random, NumbersToBothSidesAreTheUniformOnesStretchedToTheBit) {
  std::vector<double> row(1000);
  Random(6).fill_uniform(row);
  Random alone(6);
  for (const double value : row) EXPECT_EQ(value, 2.0 * alone.uniform() - 1.0);
}

TEST(RareEvents, PicksTheGivenShareForAnyRowLength) {
  RareEvents events(Random(5), 0.002);
  std::size_t picked = 0;
  std::size_t trials = 0;
  for (std::size_t row = 1; row < 2000; ++row) {
    std::size_t last = 0;
    events.draw(row, [&](std::size_t i) {
      EXPECT_LT(i, row);
      EXPECT_GE(i, last);
      last = i;
      ++picked;
    });
    trials += row;
  }
  // 1,999,000 trials: expected 3998, standard deviation 63.
  EXPECT_EQ(trials, 1999000u);
  EXPECT_NEAR(static_cast<double>(picked), 3998, 320);
}

TEST(RareEvents, NeverAtZeroAndAlwaysAtOne) {
  RareEvents never(Random(1), 0);
  RareEvents always(Random(1), 1);
  std::size_t none = 0;
  std::size_t all = 0;
  for (int row = 0; row < 10; ++row) {
    never.draw(361, [&](std::size_t) { ++none; });
    always.draw(361, [&](std::size_t i) { EXPECT_EQ(i, all++ % 361); });
  }
  EXPECT_EQ(none, 0u);
  EXPECT_EQ(all, 3610u);
}

}  // namespace
}  // namespace sim
