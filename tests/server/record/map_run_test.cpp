// tests/server/record/map_run_test.cpp: a run by a known map, stored and driven again without it.
#include <memory>
#include <string>

#include "tests/db/store_files.hpp"
#include "tests/server/map_room.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/record/headless.hpp"
#include "server/record/run_csv.hpp"
#include "server/record/run_json.hpp"
#include "server/record/verify.hpp"

namespace server {
namespace {

class MapRun : public test::StoreFiles {};

TEST_F(MapRun, AStoredRunIsRepeatedWithoutTheMap) {
  const RunSpec spec = map_room::spec_of(map_room::poor_wheels_in_a_room(), true, true);
  db::RunId run = 0;
  {
    const auto robot = make_robot(spec);
    Recorder recorder(path, {.retention_bytes = 0});
    const auto channel = recorder.begin(headless_run(spec, robot->spec(), 0));
    run = channel->run();
    const HeadlessResult result = run_headless(spec, *robot, {.record = channel}, {});
    EXPECT_EQ(result.run.outcome, algo::Outcome::Reached) << result.run.reason;
    recorder.flush();
  }
  db::RunReader reader(path);
  const Verification verified = verify_run(reader, run);
  EXPECT_GT(verified.compared, 500U);
  EXPECT_EQ(verified.difference.value_or(""), "");
  EXPECT_EQ(verified.incomplete.value_or(""), "");
  const auto row = reader.get(run);
  ASSERT_TRUE(row);
  EXPECT_FALSE(to_json(*row)["document"].contains("map"));

  // While it is lost it has a fix and a pose by the wheels, and no variances.
  const RunCsv csv(reader, *row);
  std::string lines;
  std::optional<std::uint64_t> from = 0;
  while (from) from = csv.lines(reader, *from, 1000, lines);
  const std::string header = csv.header();
  EXPECT_THAT(header,
              testing::HasSubstr("map.fix,map.places,map.epoch,map.xx,map.xy,map.yy,map.turn,"
                                 "map.fit,wheels.x,wheels.y,wheels.heading"));
  EXPECT_THAT(lines, testing::HasSubstr(",searching,0,0,,,,,,"));
  EXPECT_THAT(lines, testing::HasSubstr(",located,1,1,"));
}

}  // namespace
}  // namespace server
