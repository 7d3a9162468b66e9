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
  db::TickRow odd = row(1);
  odd.t = 0.1;
  odd.x = 1e-9;
  odd.y = -3;
  odd.v = 1.0 / 3.0;
  odd.clearance = std::nan("");
  odd.hold = "stopped";
  const auto made = frames(1);
  store.append_tick(run, odd, made[0].bytes, made[0].windows);
  db::TickRow free = row(2);
  free.hold.clear();
  store.append_tick(run, free, made[0].bytes, made[0].windows);
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
    store.append_tick(run, tick_row(t), bytes, encoder.windows());
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
