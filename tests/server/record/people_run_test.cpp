// tests/server/record/people_run_test.cpp: a hall of people who walk about and do not step aside.
#include <gtest/gtest.h>

#include "server/record/headless.hpp"
#include "server/run/run_spec.hpp"
#include "server/run/scenario_library.hpp"

namespace server {
namespace {

TEST(PeopleRun, TheRobotCrossesTheirHallWithoutTouchingAnyone) {
  for (const std::uint64_t seed : {1U, 2U}) {
    RunOverrides overrides;
    overrides.seed = seed;
    const RunSpec spec = make_spec(ScenarioLibrary({}, {}).load("people"), overrides);
    const auto robot = make_robot(spec);
    const HeadlessResult result = run_headless(spec, *robot, {}, {});
    EXPECT_EQ(result.run.outcome, algo::Outcome::Reached) << seed << ": " << result.run.reason;
  }
}

}  // namespace
}  // namespace server
