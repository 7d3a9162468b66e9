// tests/server/experiment/worlds_test.cpp: worlds stepped by actions are the worlds of a run.
#include "server/experiment/worlds.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/record/headless.hpp"
#include "server/run/scenario_library.hpp"

namespace server::experiment {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr WorldAction kAhead{.v = 0.2, .omega = 0.1};

RunSpec case1(std::uint64_t seed = 1,
              std::shared_ptr<const algo::ControllerCatalogue> controllers = {}) {
  RunOverrides overrides;
  overrides.physics = sim::PhysicsKind::Kinematic;
  overrides.seed = seed;
  overrides.controllers = std::move(controllers);
  if (overrides.controllers) overrides.controller = "ahead";
  return make_spec(ScenarioLibrary({}, {}).load("case1"), overrides);
}

/// Drives as kAhead, inside the program.
class Ahead final : public algo::Controller {
 public:
  void reset(const algo::Pose2& /*start_W*/) override {}
  void update(const algo::ControlInput& /*in*/,
              const algo::Parameters& /*parameters*/,
              algo::ControlOutput& out) override {
    out.clear();
    out.twist = {kAhead.v, kAhead.omega};
  }
  void explain(const algo::Telemetry& /*t*/, algo::Explanation& words) const override {
    words = {};
  }
};

std::vector<double> numbers(const WorldState& s) {
  return {s.stamp, s.x, s.y, s.heading, s.v, s.omega, s.clearance, s.outcome};
}

TEST(Worlds, EachGoesAsARunGoes) {
  std::vector<algo::ControllerInfo> entries{
      {.name = "ahead", .make = [] { return std::make_unique<Ahead>(); }}};
  const RunSpec spec =
      case1(4, std::make_shared<const algo::ControllerCatalogue>(std::move(entries)));
  std::vector<std::vector<double>> expected;
  HeadlessOptions options;
  options.watch = [&](const algo::Telemetry& t) -> std::optional<Ending> {
    const algo::Odometry& o = t.observation.odometry;
    expected.push_back({t.observation.stamp, o.pose.x, o.pose.y, o.pose.heading, o.twist.v});
    return std::nullopt;
  };
  const HeadlessResult result = run_headless(spec, *make_robot(spec), options, {});
  Worlds worlds(case1(3), 2);  // seeds 3 and 4
  for (const std::vector<double>& tick : expected) {
    const std::vector<double> now = numbers(worlds.states()[1]);
    ASSERT_EQ(std::vector<double>(now.begin(), now.begin() + 5), tick);
    const bool last = &tick == &expected.back();
    EXPECT_EQ(worlds.states()[1].outcome != 0, last) << tick[0];
    worlds.step(std::vector<WorldAction>(2, kAhead));
  }
  EXPECT_NE(result.run.outcome, algo::Outcome::Failed);
  EXPECT_GT(expected.size(), 100U);
}

TEST(Worlds, BeginAnewWithAnySeed) {
  Worlds worlds(case1(1), 2);
  const std::vector<float> first(worlds.ranges().begin(), worlds.ranges().end());
  const std::size_t beams = first.size() / 2;
  for (int i = 0; i < 20; ++i) worlds.step(std::vector<WorldAction>(2, kAhead));
  EXPECT_GT(worlds.states()[0].stamp, 0.5);
  // The first world takes the second one's seed, and the second its own once more.
  worlds.step(std::vector<WorldAction>(2, {.seed = 2}));
  for (std::size_t i = 0; i < beams; ++i) {
    ASSERT_EQ(worlds.ranges()[i], first[beams + i]) << i;
    ASSERT_EQ(worlds.ranges()[beams + i], first[beams + i]) << i;
  }
  EXPECT_EQ(numbers(worlds.states()[0]), numbers(worlds.states()[1]));
}

TEST(Worlds, RefuseAnActionThatIsNoNumber) {
  Worlds worlds(case1(), 1);
  const std::vector<WorldAction> bad{{.v = std::numeric_limits<double>::quiet_NaN()}};
  EXPECT_THAT(
      [&] { worlds.step(bad); },
      ThrowsMessage<std::runtime_error>(HasSubstr("World 0: an action is not a finite number.")));
}

TEST(Worlds, RefusesASeedThatIsNone) {
  Worlds worlds(case1(), 1);
  const auto begun_with = [&](double seed) {
    const std::vector<WorldAction> action{{.seed = seed}};
    return [&worlds, action] { worlds.step(action); };
  };
  EXPECT_THAT(begun_with(1e300),
              ThrowsMessage<std::runtime_error>(HasSubstr("World 0: a seed is beyond 2^53 - 1")));
  EXPECT_THAT(begun_with(std::numeric_limits<double>::quiet_NaN()),
              ThrowsMessage<std::runtime_error>(HasSubstr("not a finite number")));
}

}  // namespace
}  // namespace server::experiment
