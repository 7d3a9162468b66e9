// tests/algo/parameters_test.cpp: the table of tunable numbers and what it refuses.
#include "algo/parameters.hpp"

#include <limits>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace {

using algo::Parameter;
using algo::Parameters;

TEST(ParameterTable, IsInOrderSoundAndExplained) {
  const auto table = algo::parameter_table();
  ASSERT_EQ(table.size(), algo::kParameterCount);
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < table.size(); ++i) {
    EXPECT_EQ(table[i].id, static_cast<Parameter>(i));
    EXPECT_EQ(&algo::info(table[i].id), &table[i]);
    EXPECT_EQ(algo::find_parameter(table[i].name), table[i].id);
    EXPECT_LT(table[i].min, table[i].max);
    EXPECT_GT(table[i].step, 0);
    EXPECT_GE(table[i].initial, table[i].min);
    EXPECT_LE(table[i].initial, table[i].max);
    EXPECT_FALSE(table[i].label.empty());
    EXPECT_FALSE(table[i].help.empty());
    names.insert(table[i].name);
  }
  EXPECT_EQ(names.size(), table.size());
  EXPECT_EQ(algo::find_parameter("K_r"), std::nullopt);
}

TEST(Parameters, StartAtTheirInitialValuesWhichAreSafe) {
  const Parameters parameters;
  EXPECT_EQ(parameters[Parameter::RepulsionGain], 0.6);
  EXPECT_EQ(parameters[Parameter::StripStep], 0.2);
  EXPECT_EQ(parameters[Parameter::SafetyDistance], 1.0);
  EXPECT_EQ(algo::refusal(parameters), std::nullopt);
}

TEST(Refusal, LimitsAreInclusiveAndNamed) {
  Parameters wide;  // so that only the limit under test refuses
  wide.set(Parameter::SafetyDistance, 3.0);
  wide.set(Parameter::RepulsionGain, 1.0);
  wide.set(Parameter::StripStep, 0.05);
  for (const auto& about : algo::parameter_table()) {
    EXPECT_EQ(algo::refusal(wide, about.id, about.min), std::nullopt) << about.name;
    EXPECT_EQ(algo::refusal(wide, about.id, about.max), std::nullopt) << about.name;
    for (const double bad : {about.min - 0.01,
                             about.max + 0.01,
                             std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity()}) {
      const auto said = algo::refusal(wide, about.id, bad);
      ASSERT_TRUE(said.has_value()) << about.name << " = " << bad;
      EXPECT_EQ(said->find(about.name), 0U) << *said;
    }
  }
  EXPECT_EQ(algo::refusal(wide, Parameter::MaxSpeed, 5).value(),
            "v_max must be from 0.01 to 2 m/s, not 5");
}

TEST(Refusal, AWholeNumberIsWanted) {
  const Parameters parameters;
  EXPECT_EQ(algo::refusal(parameters, Parameter::FilterHalfWidth, 2), std::nullopt);
  EXPECT_EQ(algo::refusal(parameters, Parameter::FilterHalfWidth, 1.5).value(),
            "filter_half_width must be a whole number, not 1.5");
}

/// equations.md D, consequence 2: S must be below K_r d_safe, 600 mm at 0.6 and 300 mm at 0.3.
TEST(Refusal, AStepThatWinsOverTheForceIsUnsafe) {
  Parameters parameters;
  EXPECT_EQ(algo::refusal(parameters, Parameter::StripStep, 0.59), std::nullopt);
  const auto said = algo::refusal(parameters, Parameter::StripStep, 0.6);
  ASSERT_TRUE(said.has_value());
  EXPECT_NE(said->find("0.6 x 1 m = 0.6 m"), std::string::npos) << *said;
  EXPECT_TRUE(algo::refusal(parameters, Parameter::RepulsionGain, 0.2).has_value());
  EXPECT_EQ(algo::refusal(parameters, Parameter::RepulsionGain, 0.21), std::nullopt);
  EXPECT_TRUE(algo::refusal(parameters, Parameter::SafetyDistance, 0.3).has_value());
  EXPECT_EQ(algo::refusal(parameters, Parameter::SafetyDistance, 0.4), std::nullopt);
}

TEST(Refusal, OfAWholeSet) {
  Parameters parameters;
  parameters.set(Parameter::RepulsionGain, 0.3);
  parameters.set(Parameter::StripStep, 0.31);
  EXPECT_TRUE(algo::refusal(parameters).has_value());
  parameters.set(Parameter::StripStep, 0.29);
  EXPECT_EQ(algo::refusal(parameters), std::nullopt);
  parameters.set(Parameter::GoalReach, 0);
  EXPECT_EQ(algo::refusal(parameters).value().find("goal_reach"), 0U);
}

}  // namespace
