// tests/algo/pipeline/parameter_table_test.cpp: the table of all parameters and its refusals.
#include "algo/pipeline/parameter_table.hpp"

#include <algorithm>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "algo/driving.hpp"
#include "algo/filter/filter.hpp"
#include "algo/pipeline/controllers.hpp"
#include "algo/strip/strip_law.hpp"

namespace {

using algo::kFilterHalfWidth;
using algo::kGoalReach;
using algo::kMaxSpeed;
using algo::kRepulsionGain;
using algo::kSafetyDistance;
using algo::kStripStep;
using algo::ParameterInfo;
using algo::Parameters;

TEST(ParameterTable, IsSoundAndExplained) {
  const auto table = algo::parameter_table();
  ASSERT_GE(table.size(), 12U);
  std::set<std::string_view> names;
  for (const ParameterInfo* each : table) {
    EXPECT_EQ(algo::find_parameter(each->name), each);
    EXPECT_EQ(algo::find_parameter(each->key()), each);
    EXPECT_NE(each->name.find('.'), std::string_view::npos) << "its component's name comes first";
    EXPECT_LT(each->min, each->max) << each->name;
    EXPECT_GT(each->step, 0) << each->name;
    EXPECT_GE(each->initial, each->min) << each->name;
    EXPECT_LE(each->initial, each->max) << each->name;
    EXPECT_FALSE(each->label.empty()) << each->name;
    EXPECT_FALSE(each->help.empty()) << each->name;
    names.insert(each->name);
    names.insert(each->key());
  }
  const auto aliases =
      std::ranges::count_if(table, [](const ParameterInfo* each) { return !each->alias.empty(); });
  EXPECT_EQ(names.size(), table.size() + static_cast<std::size_t>(aliases)) << "no name means two";
  EXPECT_EQ(algo::find_parameter("K_r"), nullptr);
  EXPECT_EQ(algo::find_parameter(""), nullptr);
}

TEST(ParameterTable, KnowsTheOlderNames) {
  for (const char* name : {"k_c",
                           "k_r",
                           "safety_distance",
                           "strip_step",
                           "v_max",
                           "w_max",
                           "heading_gain",
                           "goal_reach",
                           "filter_half_width",
                           "scan_timeout",
                           "joystick_timeout",
                           "nearest_goal"}) {
    ASSERT_NE(algo::find_parameter(name), nullptr) << name;
    EXPECT_EQ(algo::find_parameter(name)->key(), name);
  }
  EXPECT_EQ(algo::find_parameter("strip.k_r"), algo::find_parameter("k_r"));
}

TEST(ParameterTable, HasEveryParameterThatControllersRead) {
  for (const algo::ControllerInfo& controller : algo::builtin_controllers().entries()) {
    EXPECT_FALSE(controller.parameters.empty()) << controller.name;
    for (const ParameterInfo* each : controller.parameters) {
      EXPECT_EQ(algo::find_parameter(each->name), each) << controller.name;
    }
  }
}

TEST(ParameterTable, OffersTheContractionGainOnlyWhereItActs) {
  std::vector<std::string> readers;
  for (const algo::ControllerInfo& controller : algo::builtin_controllers().entries()) {
    if (std::ranges::find(controller.parameters, &algo::kContractionGain) !=
        controller.parameters.end()) {
      readers.emplace_back(controller.name);
    }
  }
  EXPECT_EQ(readers, (std::vector<std::string>{"via_kept", "strip", "strip_moving"}));
}

TEST(Parameters, StartAtTheirInitialValuesWhichAreSafe) {
  const Parameters parameters;
  EXPECT_EQ(parameters[kRepulsionGain], 0.6);
  EXPECT_EQ(parameters[kStripStep], 0.2);
  EXPECT_EQ(parameters[kSafetyDistance], 1.0);
  EXPECT_EQ(algo::refusal(parameters), std::nullopt);
}

TEST(Parameters, AreTheSameWhenTheirValuesAre) {
  Parameters once;
  once.set(kMaxSpeed, 0.5);
  Parameters twice;
  twice.set(kRepulsionGain, 0.3);
  twice.set(kMaxSpeed, 0.5);
  EXPECT_NE(once, twice);
  twice.set(kRepulsionGain, kRepulsionGain.initial);
  EXPECT_EQ(once, twice);
  EXPECT_EQ(twice[kMaxSpeed], 0.5);
  EXPECT_EQ(twice.settings().size(), 2U);
}

TEST(Parameters, TellWhetherAllAreFinite) {
  Parameters parameters;
  EXPECT_TRUE(parameters.all_finite());
  parameters.set(kMaxSpeed, std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(parameters.all_finite());
}

TEST(Refusal, LimitsAreInclusiveAndNamed) {
  Parameters wide;  // so that only the limit under test refuses
  wide.set(kSafetyDistance, 3.0);
  wide.set(kRepulsionGain, 1.0);
  wide.set(kStripStep, 0.05);
  for (const ParameterInfo* about : algo::parameter_table()) {
    EXPECT_EQ(algo::refusal(wide, *about, about->min), std::nullopt) << about->name;
    EXPECT_EQ(algo::refusal(wide, *about, about->max), std::nullopt) << about->name;
    for (const double bad : {about->min - 0.01,
                             about->max + 0.01,
                             std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity()}) {
      const auto said = algo::refusal(wide, *about, bad);
      ASSERT_TRUE(said.has_value()) << about->name << " = " << bad;
      EXPECT_EQ(said->find(about->key()), 0U) << *said;
    }
  }
  EXPECT_EQ(algo::refusal(wide, kMaxSpeed, 5).value(), "v_max must be from 0.01 to 2 m/s, not 5");
}

TEST(Refusal, AnIntegerParameterRefusesFractions) {
  const Parameters parameters;
  EXPECT_EQ(algo::refusal(parameters, kFilterHalfWidth, 2), std::nullopt);
  EXPECT_EQ(algo::refusal(parameters, kFilterHalfWidth, 1.5).value(),
            "filter_half_width must be a whole number, not 1.5");
}

/// equations.md D, consequence 2: S must be below K_r d_safe, 600 mm at 0.6 and 300 mm at 0.3.
TEST(Refusal, AStepLargerThanTheForceIsUnsafe) {
  Parameters parameters;
  EXPECT_EQ(algo::refusal(parameters, kStripStep, 0.59), std::nullopt);
  const auto said = algo::refusal(parameters, kStripStep, 0.6);
  ASSERT_TRUE(said.has_value());
  EXPECT_NE(said->find("0.6 x 1 m = 0.6 m"), std::string::npos) << *said;
  EXPECT_TRUE(algo::refusal(parameters, kRepulsionGain, 0.2).has_value());
  EXPECT_EQ(algo::refusal(parameters, kRepulsionGain, 0.21), std::nullopt);
  EXPECT_TRUE(algo::refusal(parameters, kSafetyDistance, 0.3).has_value());
  EXPECT_EQ(algo::refusal(parameters, kSafetyDistance, 0.4), std::nullopt);
}

TEST(Refusal, OfAWholeSet) {
  Parameters parameters;
  parameters.set(kRepulsionGain, 0.3);
  parameters.set(kStripStep, 0.31);
  EXPECT_TRUE(algo::refusal(parameters).has_value());
  parameters.set(kStripStep, 0.29);
  EXPECT_EQ(algo::refusal(parameters), std::nullopt);
  parameters.set(kGoalReach, 0);
  EXPECT_EQ(algo::refusal(parameters).value().find("goal_reach"), 0U);
}

}  // namespace
