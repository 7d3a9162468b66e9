// tests/server/experiment/rows_test.cpp: runs kept side by side are those that were put in.
#include "server/experiment/sweep/rows.hpp"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace server::sweep {
namespace {

using algo::Outcome;
using experiment::Row;

Row measured(double time) {
  Row row{.outcome = Outcome::Stuck, .reason = "It stands."};
  for (const std::string_view column : Rows::columns()) row.figures.emplace_back(column, time++);
  return row;
}

TEST(Rows, GivesBackWhatWasSet) {
  Rows rows(3);
  EXPECT_FALSE(rows.has(1));
  const Row row = measured(7);
  rows.set(1, row);
  EXPECT_TRUE(rows.has(1));
  EXPECT_FALSE(rows.has(0));
  EXPECT_FALSE(rows.has(2));
  EXPECT_FALSE(rows.broken(1));
  EXPECT_EQ(rows.row(1).outcome, Outcome::Stuck);
  EXPECT_EQ(rows.row(1).reason, "It stands.");
  EXPECT_EQ(rows.row(1).figures, row.figures);
  EXPECT_EQ(rows.figure(1, Rows::columns().back()), 6 + static_cast<double>(row.figures.size()));
}

TEST(Rows, ALaterRunLeavesNothingOfTheEarlier) {
  Rows rows(1);
  rows.set(0, measured(7));
  rows.set(0, {.outcome = Outcome::Failed, .broken = true});
  EXPECT_TRUE(rows.broken(0));
  EXPECT_TRUE(rows.row(0).figures.empty());
  EXPECT_TRUE(std::isnan(rows.figure(0, "time_s")));
  rows.erase(0);
  EXPECT_FALSE(rows.has(0));
  EXPECT_FALSE(rows.broken(0));
}

TEST(Rows, FiguresAreFoundByNameWhateverTheirOrder) {
  Rows rows(1);
  rows.set(0, {.outcome = Outcome::Reached, .figures = {{"path_m", 2.0}, {"time_s", 9.0}}});
  EXPECT_EQ(rows.figure(0, "time_s"), 9);
  EXPECT_EQ(rows.figure(0, "path_m"), 2);
  EXPECT_TRUE(std::isnan(rows.figure(0, "turn_flips")));
  EXPECT_TRUE(std::isnan(rows.figure(0, "barn_score")));  // of a judge that no experiment has
  EXPECT_THROW(rows.set(0, {.figures = {{"barn_score", 1.0}}}), std::out_of_range);
}

}  // namespace
}  // namespace server::sweep
