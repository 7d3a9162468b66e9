// tests/server/external/allocation_test.cpp: a steady round trip allocates nothing on this side.
#include "tests/algo/allocations.hpp"
#include "tests/server/external/own.hpp"
#include <gtest/gtest.h>

namespace server::external {
namespace {

TEST(Allocation, ASteadyRoundTripAllocatesNothing) {
  for (const std::string& command :
       {std::string(TAUTLINE_EXAMPLE_CONTROLLER), example("go_to_goal.py")}) {
    const RunSpec spec = spec_of(catalogue_of({.name = "mine", .command = command}));
    drive(spec);  // the first run of a program fills buffers of the simulator
    const auto robot = make_robot(spec);
    std::size_t before = 0;
    std::size_t after = 0;
    HeadlessOptions options;
    options.watch = [&](const algo::Telemetry& t) -> std::optional<Ending> {
      if (t.tick == 200) before = allocations::count();
      if (t.tick == 500) after = allocations::count();
      return std::nullopt;
    };
    run_headless(spec, *robot, options, {});
    ASSERT_GT(after, 0U) << "the run was too short";
    EXPECT_EQ(after - before, 0U) << command;
  }
}

}  // namespace
}  // namespace server::external
