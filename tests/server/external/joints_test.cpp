// tests/server/external/joints_test.cpp: a controller outside the program sees the joints of an arm
// and turns them.
#include "tests/server/external/own.hpp"
#include "tests/temporary_folder.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/record/run_json.hpp"
#include "server/record/verify.hpp"

namespace server::external {
namespace {

Registration turning() {
  return {.name = "mine", .command = python("turning.py")};
}

RunSpec drive_with_an_arm() {
  RunSpec spec = spec_of(catalogue_of(turning()), "arm_post");
  spec.scenario.carry = false;
  spec.scenario.obstacles.clear();
  spec.scenario.joints.reset();
  return spec;
}

TEST(ExternalJoints, AreSeenAndTurnedAndTheRecordHasTheirRates) {
  const tests::TemporaryFolder folder;
  const std::string database = (folder.path() / "runs.db").string();
  const RunSpec spec = drive_with_an_arm();
  db::RunId id = 0;
  double last = 0;
  double way = 0;
  {
    Recorder recorder(database, recorder_options());
    const auto robot = make_robot(spec);
    HeadlessOptions options;
    options.record = recorder.open(headless_run(spec, robot->spec(), 0));
    options.watch = [&](const algo::Telemetry& t) {
      last = t.observation.joints->position[6];
      way = t.ground_truth->pose.x;
      const bool over = t.tick == 150;
      return over ? std::optional<Ending>({.outcome = algo::Outcome::Stopped}) : std::nullopt;
    };
    run_headless(spec, *robot, options, {});
    recorder.flush();
    id = options.record->run();
  }
  EXPECT_NEAR(last, 1, 0.02);
  EXPECT_GT(way, 0.2);
  db::RunReader reader(database);
  const Verification again = verify_run(reader, id);
  EXPECT_FALSE(again.difference) << *again.difference;
  EXPECT_GT(again.compared, 100U);
}

TEST(ExternalJoints, CannotBeTurnedWithoutAnArm) {
  const HeadlessResult result = drive(spec_of(catalogue_of(turning()), "case1"));
  EXPECT_EQ(result.run.outcome, algo::Outcome::Failed);
  EXPECT_THAT(result.run.reason,
              ::testing::HasSubstr("commands joints, and this robot has no arm"));
}

}  // namespace
}  // namespace server::external
