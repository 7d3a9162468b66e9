// tests/sim/allocation_test.cpp: a steady tick of the simulated robot allocates nothing.
#include "tests/algo/allocations.hpp"
#include "tests/sim/reference_world.hpp"
#include <gtest/gtest.h>

#include "sim/world.hpp"

namespace sim {
namespace {

TEST(Allocation, ASteadyTickAllocatesNothing) {
  for (const PhysicsKind physics : {PhysicsKind::Bullet, PhysicsKind::Kinematic}) {
    Scenario scenario;
    scenario.physics = physics;
    scenario.obstacles = reference::room(20);
    World world(scenario, 1);
    algo::Observation seen;
    world.reset(seen);
    const auto drive = [&](int ticks) {
      for (int tick = 0; tick < ticks; ++tick) {
        ASSERT_TRUE(world.step({{0.3, 0.6}}, seen));
        ASSERT_TRUE(world.ground_truth().has_value());
      }
    };
    drive(800);  // twice round the circle: every buffer has had its largest size
    const std::size_t before = allocations::count();
    drive(800);
    EXPECT_EQ(allocations::count() - before, 0u);
  }
}

}  // namespace
}  // namespace sim
