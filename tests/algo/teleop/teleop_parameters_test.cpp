// tests/algo/teleop/teleop_parameters_test.cpp: the parameters of the laws for driving by hand.
#include "algo/teleop/teleop_parameters.hpp"

#include "tests/algo/not_finite.hpp"
#include <gtest/gtest.h>

namespace {

using algo::Parameters;

using tests::kNan;

TEST(TeleopRefusal, WantsTheStopDistanceOutsideTheHullAndWithinReach) {
  Parameters parameters;
  EXPECT_EQ(algo::teleop_refusal(parameters, 0.39), std::nullopt);
  EXPECT_NE(algo::teleop_refusal(parameters, 0.5), std::nullopt);
  EXPECT_NE(algo::teleop_refusal(parameters, kNan), std::nullopt);
  parameters.set(algo::kStopDistance, 2.0);
  parameters.set(algo::kRingReach, 2.0);
  EXPECT_NE(algo::teleop_refusal(parameters, 0.39), std::nullopt);
}

TEST(TeleopParameters, AreSoundAndExplained) {
  for (const algo::ParameterInfo* each : algo::kTeleopParameters) {
    EXPECT_TRUE(each->name.starts_with("teleop.")) << each->name;
    EXPECT_LT(each->min, each->max) << each->name;
    EXPECT_GT(each->step, 0) << each->name;
    EXPECT_GE(each->initial, each->min) << each->name;
    EXPECT_LE(each->initial, each->max) << each->name;
    EXPECT_FALSE(each->label.empty() || each->help.empty()) << each->name;
  }
}

}  // namespace
