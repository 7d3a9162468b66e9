// tests/algo/strip/damping_test.cpp: our damping of the three-point strips' swinging.
#include <cmath>
#include <string>

#include "tests/algo/baselines/drive.hpp"
#include <gtest/gtest.h>

#include "algo/strip/strip_law.hpp"

namespace {

/// A run between two walls that the strip swings between.
struct Swinging {
  baselines::Outcome outcome{};
  double change = 0;  // [rad/s] sum of the changes of the commanded turn
};

Swinging swing(const std::string& controller, double damping) {
  const worlds::World world{
      {{{1.6, 1.1}, 0.15}, {{2.6, -1.1}, 0.15}, {{3.6, 1.1}, 0.15}, {{4.6, -1.1}, 0.15}}, {}};
  baselines::Drive drive(controller, world, {6, 0});
  drive.parameters().set(algo::kDamping, damping);
  Swinging out;
  double last = 0;
  drive.watch([&](const algo::ControlOutput& told) {
    out.change += std::abs(told.twist.omega - last);
    last = told.twist.omega;
  });
  out.outcome = drive.run();
  return out;
}

class DampedStrip : public ::testing::TestWithParam<std::string> {};

TEST_P(DampedStrip, TurnsLessToAndFroAndStillArrives) {
  const Swinging published = swing(GetParam(), 0);
  const Swinging damped = swing(GetParam(), 0.2);
  EXPECT_EQ(published.outcome.name, "reached");
  EXPECT_EQ(damped.outcome.name, "reached");
  EXPECT_LT(damped.change, 0.6 * published.change);
}

INSTANTIATE_TEST_SUITE_P(All,
                         DampedStrip,
                         ::testing::Values("modified", "modified_c1", "original"),
                         [](const auto& info) { return info.param; });

}  // namespace
