// tests/sim/allocation_test.cpp: a steady tick of the simulated robot allocates nothing.
#include <atomic>
#include <cstdlib>
#include <new>

#include "tests/sim/reference_world.hpp"
#include <gtest/gtest.h>

#include "sim/world.hpp"

namespace {
std::atomic<std::size_t> allocations{0};  // a replaced operator new has nowhere else to count
}

// Not inlined, or the compiler sees malloc() and free() paired with new and delete and warns.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t /*size*/) noexcept {
  std::free(memory);
}

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
    const std::size_t before = allocations;
    drive(800);
    EXPECT_EQ(allocations - before, 0u);
  }
}

}  // namespace
}  // namespace sim
