// tests/drivers/psd_table_test.cpp: from a voltage to a distance.
#include "drivers/psd_table.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace drivers::psd {
namespace {

/// [m] the inverse of the usual curve, worked out by hand: L = 23.9 / (V - 0.09) - 0.42 in cm.
double usual(double volts) {
  return (23.9 / (volts - 0.09) - 0.42) / 100;
}

TEST(PsdTable, TheUsualOneFollowsTheCurve) {
  const Table table;
  for (double metres = 0.101; metres < 0.7995; metres += 0.001) {
    const double volts = 0.09 + 23.9 / (100 * metres + 0.42);
    EXPECT_NEAR(table.distance(volts), usual(volts), 1e-9) << metres;
  }
  EXPECT_NEAR(table.distance(0.09 + 23.9 / 20.42), 0.2, 1e-9);
}

TEST(PsdTable, NothingIsMeasuredOutOfRange) {
  const Table table;
  EXPECT_TRUE(std::isnan(table.distance(2.46)));  // the curve folds back there
  EXPECT_TRUE(std::isnan(Table({{3, 0.1}, {1, 0.3}}).distance(2.46)));
  EXPECT_TRUE(std::isnan(table.distance(2.40)));  // 0.099 m
  EXPECT_TRUE(std::isnan(table.distance(0.38)));  // 0.82 m
  EXPECT_TRUE(std::isnan(table.distance(0.05)));
  EXPECT_TRUE(std::isnan(table.distance(0)));
  EXPECT_TRUE(std::isnan(table.distance(-1)));
  EXPECT_TRUE(std::isnan(table.distance(std::nan(""))));
  EXPECT_TRUE(std::isnan(table.distance(std::numeric_limits<double>::infinity())));
}

TEST(PsdTable, IsLinearInTheInverseOfTheDistance) {
  const Table table({{2.0, 0.1}, {1.0, 0.2}, {0.4, 0.6}});
  EXPECT_NEAR(table.distance(1.5), 1 / 7.5, 1e-12);
  EXPECT_NEAR(table.distance(1.0), 0.2, 1e-12);
  // 1/L from 5 to 5/3 while the voltage falls from 1 to 0.4.
  EXPECT_NEAR(table.distance(0.7), 1 / (5 - (5 - 5.0 / 3) / 2), 1e-12);
  EXPECT_NEAR(table.distance(0.34), 1 / (5.0 / 3 - (5 - 5.0 / 3) / 10), 1e-12);  // beyond
}

TEST(PsdTable, AMeaninglessOneIsRefused) {
  EXPECT_THAT(*defect({{2, 0.1}}), testing::HasSubstr("two points"));
  EXPECT_THAT(*defect({{2, 0.1}, {2, 0.2}}), testing::HasSubstr("less voltage"));
  EXPECT_THAT(*defect({{2, 0.2}, {1, 0.1}}), testing::HasSubstr("near to far"));
  EXPECT_THAT(*defect({{2, 0.2}, {std::nan(""), 0.3}}), testing::HasSubstr("0 to 5 V"));
  EXPECT_THAT(*defect({{2, 20}, {1, 30}}), testing::HasSubstr("0.05 to 2 m"));
  EXPECT_THROW(Table({{2, 0.1}}), std::invalid_argument);
}

}  // namespace
}  // namespace drivers::psd
