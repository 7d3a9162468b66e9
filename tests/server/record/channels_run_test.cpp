// tests/server/record/channels_run_test.cpp: a further sensor reaches the record and the CSV, and a
// run with it verifies.
#include <string>

#include "tests/server/record/recorder_fixture.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/record/headless.hpp"
#include "server/record/run_csv.hpp"
#include "server/record/run_json.hpp"
#include "server/record/verify.hpp"
#include "server/run/scenario_json.hpp"

namespace server {
namespace {

using ChannelsRun = test::RecorderFiles;

TEST_F(ChannelsRun, AScriptedSensorReachesRecordAndCsv) {
  const auto scenario = scenario_from_json(nlohmann::json::parse(
      R"({"name":"battery","vehicle":"kinematic","goal":{"x":2,"y":0},"sensors":[)"
      R"({"sensor":"scripted","channel":"battery.voltage","unit":"V","period":1,)"
      R"("times":[0,4],"values":[25,24]}]})"));
  const RunSpec spec = make_spec(scenario, {});
  const auto robot = make_robot(spec);
  db::RunId run = 0;
  {
    Recorder recorder(path, {.retention_bytes = 0});
    const auto channel = recorder.begin(headless_run(spec, robot->spec(), 0));
    run = channel->run();
    const HeadlessResult result = run_headless(spec, *robot, {.record = channel}, {});
    EXPECT_EQ(result.run.outcome, algo::Outcome::Reached);
    recorder.flush();
  }
  db::RunReader reader(path);
  const Verification verification = verify_run(reader, run);
  EXPECT_EQ(verification.difference, std::nullopt);
  EXPECT_EQ(verification.incomplete, std::nullopt);
  const RunCsv csv(reader, *reader.get(run));
  EXPECT_THAT(csv.header(), testing::HasSubstr(",behaviour,battery.voltage,odometry.stamp,"));
  std::string lines;
  csv.lines(reader, 0, 1000, lines);
  EXPECT_THAT(lines, testing::HasSubstr(",avoid,25,0,"));
  EXPECT_THAT(lines, testing::HasSubstr(",none,avoid,,"));
  EXPECT_THAT(lines, testing::HasSubstr(",none,avoid,24.74"));
}

}  // namespace
}  // namespace server
