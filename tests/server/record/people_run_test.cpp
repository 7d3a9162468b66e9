// tests/server/record/people_run_test.cpp: a hall of walking people who do not give way.
#include <memory>

#include <gtest/gtest.h>

#include "server/record/headless.hpp"
#include "server/run/run_spec.hpp"
#include "server/run/runner.hpp"
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

/// The page draws people at the recorded positions, so these must be the true ones.
TEST(PeopleRun, RecordsTheirPositionsInEachTick) {
  const RunSpec spec = make_spec(ScenarioLibrary({}, {}).load("people"), {});
  std::vector<algo::Obstacle> people = spec.scenario.obstacles;
  std::erase_if(people, [](const algo::Obstacle& o) { return !o.path; });
  const auto robot = make_robot(spec);
  const std::shared_ptr<FramePool> pool = FramePool::make(2);
  std::size_t ticks = 0;
  double walked = 0;
  algo::Vec2 last_W{0, 0};
  RunLinks links;
  links.pool = pool.get();
  links.listeners.push_back([&](const Frame& frame) {
    const algo::Telemetry& t = frame.telemetry;
    ASSERT_EQ(t.moved.size(), people.size());
    for (std::size_t k = 0; k < t.moved.size(); ++k) {
      EXPECT_EQ(t.moved[k].id, people[k].id);
      EXPECT_EQ(t.moved[k].pose_W.position(), people[k].path->at(t.observation.stamp));
    }
    const algo::Vec2 here_W = t.moved[0].pose_W.position();
    if (ticks++ > 0) walked += (here_W - last_W).norm();
    last_W = here_W;
  });
  algo::Pipeline pipeline(pipeline_config(spec), robot->spec());
  run(*robot, pipeline, {}, {.until_outcome = true, .time_limit = 3}, links, {});
  EXPECT_GT(ticks, 60U);
  EXPECT_GT(walked, 0.5);
}

}  // namespace
}  // namespace server
