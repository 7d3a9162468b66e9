// tests/algo/full_strip/progress_watch_test.cpp: the two clocks.
#include "algo/full_strip/progress_watch.hpp"

#include <gtest/gtest.h>

namespace {

TEST(ProgressWatch, TurningIsProgressButKeepsThePlace) {
  algo::ProgressWatch watch;
  watch.restart({0, 0}, 10);
  watch.see({0.1, 0}, 12, false);
  EXPECT_EQ(watch.without_progress(12), 2);
  watch.see({0.1, 0}, 13, true);
  EXPECT_EQ(watch.without_progress(13), 0);
  EXPECT_EQ(watch.in_place(13), 3);
  watch.see({0.3, 0}, 14, false);
  EXPECT_EQ(watch.in_place(14), 0);
}

TEST(ProgressWatch, ASlowRobotGetsMoreTime) {
  EXPECT_EQ(algo::ProgressWatch::time_for(2.5, 0.5), 2.5);
  EXPECT_NEAR(algo::ProgressWatch::time_for(2.5, 0.05), 9, 1e-9);
}

}  // namespace
