// tests/server/record/run_csv_test.cpp: every number exact, in pieces, with the channels of the
// robot.
#include "server/record/run_csv.hpp"

#include <cmath>
#include <string>

#include "tests/db/store_files.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "algo/gate.hpp"
#include "server/record/frame_codec.hpp"
#include "server/record/run_json.hpp"
#include "server/run/run_spec.hpp"

namespace server {
namespace {

class RunCsvTest : public test::StoreFiles {
 protected:
  static db::NewRun of_robot(const algo::RobotSpec& robot) {
    db::NewRun run = what();
    run.document = nlohmann::json{{"robot", to_json(robot)}}.dump();
    return run;
  }
  static algo::RobotSpec paper_robot() {
    algo::RobotSpec robot;
    robot.name = "paper";
    return robot;
  }
  /// All lines of `run`, `limit` at a time.
  std::string whole(db::RunId run, std::size_t limit) const {
    db::RunReader reader(path);
    const RunCsv csv(*reader.get(run));
    std::string out = csv.header();
    std::optional<std::uint64_t> from = 0;
    while (from) from = csv.lines(reader, *from, limit, out);
    return out;
  }
};

TEST_F(RunCsvTest, IsExactAndInPieces) {
  db::RunStore store(path);
  const db::RunId run = store.begin_run(of_robot(paper_robot()));
  FrameEncoder encoder;
  const auto add = [&](const algo::Telemetry& t) {
    const auto bytes = encoder.encode(t);
    store.append_tick(run, t.tick, t.observation.stamp, bytes, encoder.windows());
  };
  algo::Telemetry odd;
  odd.tick = 1;
  odd.observation.stamp = 0.1;
  odd.observation.odometry.pose = {1e-9, -3, 0.001};
  odd.command.base = {1.0 / 3.0, 1.0 / 3.0};
  odd.clearance = std::nan("");
  odd.hold.name = "stopped";
  odd.behaviour = "avoid";
  add(odd);
  algo::Telemetry free = odd;
  free.tick = 2;
  free.observation.stamp = 0.052;
  free.observation.odometry.pose = {0.2, -0.4, 0.002};
  free.command.base = {0.5, 1.0 / 3.0};
  free.clearance = 0.65;
  free.hold = {};
  add(free);
  store.commit();
  const std::string expected =
      "tick,t,x,y,heading,v,omega,clearance,hold,behaviour\n"
      "1,0.1,1e-09,-3,0.001,0.3333333333333333,0.3333333333333333,,stopped,avoid\n"
      "2,0.052,0.2,-0.4,0.002,0.5,0.3333333333333333,0.65,none,avoid\n";
  EXPECT_EQ(whole(run, 1), expected);
  EXPECT_EQ(whole(run, 100), expected);
}

TEST_F(RunCsvTest, ChannelsAreColumnsWithACellWhereThereIsAReading) {
  algo::RobotSpec robot = paper_robot();
  robot.channels = {{.name = "battery.voltage", .unit = "V"}, {.name = "field", .values = 2}};
  db::RunStore store(path);
  const db::RunId run = store.begin_run(of_robot(robot));
  FrameEncoder encoder;
  for (std::uint64_t tick = 0; tick < 3; ++tick) {
    algo::Telemetry t;
    t.tick = tick;
    if (tick == 1) {
      t.observation.channels.append() = {.channel = 1, .stamp = 0, .values = {1.0 / 3.0, -2}};
    }
    if (tick == 2) t.observation.channels.append() = {.channel = 0, .stamp = 0, .values = {24.5}};
    const auto bytes = encoder.encode(t);
    store.append_tick(run, t.tick, t.observation.stamp, bytes, encoder.windows());
  }
  store.commit();
  for (const std::size_t limit : {1U, 2U, 100U}) {
    const std::string csv = whole(run, limit);
    EXPECT_THAT(
        csv,
        testing::StartsWith("tick,t,x,y,heading,v,omega,clearance,hold,behaviour,battery.voltage,"
                            "field[0],field[1]\n0,0,"));
    EXPECT_THAT(csv, testing::HasSubstr(",none,rest,,,\n1,"));
    EXPECT_THAT(csv, testing::HasSubstr(",none,rest,,0.3333333333333333,-2\n2,"));
    EXPECT_THAT(csv, testing::EndsWith(",none,rest,24.5,,\n"));
  }
}

}  // namespace
}  // namespace server
