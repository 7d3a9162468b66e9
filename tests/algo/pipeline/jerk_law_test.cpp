// tests/algo/pipeline/jerk_law_test.cpp: commands of controllers that keep to the robot's jerk.
#include <cmath>
#include <string>
#include <vector>

#include "tests/algo/baselines/drive.hpp"
#include <gtest/gtest.h>

#include "algo/full_strip/full_strip_parameters.hpp"

namespace {

using algo::Vec2;

std::vector<std::string> gentle_controllers() {
  std::vector<std::string> names;
  for (const algo::ControllerInfo& each : algo::builtin_controllers().entries()) {
    if (each.keeps_jerk) names.emplace_back(each.name);
  }
  return names;
}

/// What is asked of the base in a run, against its limits of jerk.
struct Asked {
  baselines::Outcome outcome{};
  int ticks = 0, hard = 0;
  double most = 0, most_turn = 0;  // [m/s3], [rad/s3] apart from hard commands
};

Asked drive(const std::string& controller, const worlds::World& world, double jerk, double turn) {
  Asked asked;
  baselines::Drive drive(controller, world, Vec2(6, 0));
  drive.spec().max_jerk = jerk;
  drive.spec().max_angular_jerk = turn;
  algo::Twist2 last, rate;
  const double dt = drive.spec().period;
  drive.watch([&](const algo::ControlOutput& out) {
    const algo::Twist2 now{(out.twist.v - last.v) / dt, (out.twist.omega - last.omega) / dt};
    ++asked.ticks;
    if (out.measure(algo::kHardCommand).value_or(0) > 0) {
      ++asked.hard;
    } else {
      asked.most = std::max(asked.most, std::abs(now.v - rate.v) / dt);
      asked.most_turn = std::max(asked.most_turn, std::abs(now.omega - rate.omega) / dt);
    }
    last = out.twist;
    rate = now;
  });
  asked.outcome = drive.run();
  return asked;
}

const std::vector<worlds::World> kWorlds{
    {{}, {}},
    {{{{3, 0.1}, 0.3}}, {}},
    {{{{2, 0.7}, 0.2}, {{3.2, -0.5}, 0.25}, {{4.4, 0.6}, 0.3}}, {}},
    {{},
     {{{3, -3}, {3.1, -3}, {3.1, -0.45}, {3, -0.45}}, {{3, 0.5}, {3.1, 0.5}, {3.1, 3}, {3, 3}}}},
};

class GentleController : public ::testing::TestWithParam<std::string> {};

TEST_P(GentleController, KeepsToTheJerkOfTheRobotButForFewCommandsThatItTells) {
  for (std::size_t i = 0; i < kWorlds.size(); ++i) {
    SCOPED_TRACE(i);
    for (const auto& [jerk, turn] : {std::pair{2.0, 20.0}, {1.0, 10.0}}) {
      const Asked asked = drive(GetParam(), kWorlds[i], jerk, turn);
      EXPECT_EQ(asked.outcome.name, "reached");
      EXPECT_LE(asked.most, jerk * (1 + 1e-6));
      EXPECT_LE(asked.most_turn, turn * (1 + 1e-6));
      EXPECT_LE(asked.hard, asked.ticks / 20);
    }
  }
}

TEST_P(GentleController, WithoutALimitTellsOfNone) {
  const Asked asked = drive(GetParam(), kWorlds[1], 0, 0);
  EXPECT_EQ(asked.outcome.name, "reached");
  EXPECT_EQ(asked.hard, 0);
  EXPECT_GT(asked.most, 2) << "it needs the limit";
}

INSTANTIATE_TEST_SUITE_P(All,
                         GentleController,
                         ::testing::ValuesIn(gentle_controllers()),
                         [](const auto& info) { return info.param; });

TEST(GentleControllers, AreTheFullStrips) {
  EXPECT_EQ(gentle_controllers(), (std::vector<std::string>{"strip", "strip_moving"}));
}

}  // namespace
