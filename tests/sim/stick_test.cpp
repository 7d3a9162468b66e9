// tests/sim/stick_test.cpp: minutes of random stick motion; `tautline soak --operator` drives for
// any time.
#include "tests/sim/stick_drive.hpp"
#include <gtest/gtest.h>

namespace {

struct StickTest : ::testing::TestWithParam<std::tuple<const char*, sim::PhysicsKind>> {};

TEST_P(StickTest, TouchesNothingWhileItMoves) {
  const auto& [robot, physics] = GetParam();
  stick::Outcome sum;
  for (const char* name : stick::kWorlds) {
    for (const std::uint64_t seed : {1U, 2U}) {
      const stick::Outcome one =
          stick::drive(stick::world(name, robot, physics), seed, 20, stick::RandomStick(seed));
      for (const std::string& where : one.where) ADD_FAILURE() << name << ": " << where;
      sum.driven += one.driven;
      sum.turned += one.turned;
      EXPECT_LE(one.fastest_back, 0.11);
    }
  }
  EXPECT_GT(sum.driven, 10) << "it must not stand still to be safe";
  EXPECT_GT(sum.turned, 15);
}

/// The guard must also brake in time when commands act late.
TEST(Stick, TouchesNothingWithADelay) {
  for (const char* robot : {"silvermate", "jackal"}) {
    sim::Scenario scenario = stick::world("room", robot, sim::PhysicsKind::Bullet);
    scenario.drive.delay_ticks = 3;
    const stick::Outcome one = stick::drive(scenario, 3, 40, stick::RandomStick(3));
    for (const std::string& where : one.where) ADD_FAILURE() << robot << ": " << where;
  }
}

INSTANTIATE_TEST_SUITE_P(DiscAndRectangle,
                         StickTest,
                         ::testing::Combine(::testing::Values("silvermate", "jackal"),
                                            ::testing::Values(sim::PhysicsKind::Kinematic,
                                                              sim::PhysicsKind::Bullet)));

}  // namespace
