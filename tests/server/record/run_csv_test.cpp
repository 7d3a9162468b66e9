// tests/server/record/run_csv_test.cpp: every number exact, in pieces, with all values of a frame.
#include "server/record/run_csv.hpp"

#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <vector>

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
  /// Stores `ticks` as one run.
  db::RunId stored(const algo::RobotSpec& robot, const std::vector<algo::Telemetry>& ticks) {
    db::RunStore store(path);
    const db::RunId run = store.begin_run(of_robot(robot));
    FrameEncoder encoder;
    for (const algo::Telemetry& t : ticks) {
      const auto bytes = encoder.encode(t);
      store.append_tick(run, t.tick, t.observation.stamp, bytes, encoder.windows());
    }
    store.commit();
    return run;
  }
  /// All lines of `run`, `limit` at a time.
  std::string whole(db::RunId run, std::size_t limit, CsvOptions options = {}) const {
    db::RunReader reader(path);
    const RunCsv csv(reader, *reader.get(run), options);
    std::string out = csv.header();
    std::optional<std::uint64_t> from = 0;
    while (from) from = csv.lines(reader, *from, limit, out);
    return out;
  }
  /// The cells of `text` by column, for texts without commas in cells.
  static std::map<std::string, std::vector<std::string>> table(const std::string& text) {
    std::istringstream lines(text);
    const auto cells = [](const std::string& line) {
      std::vector<std::string> out{""};
      for (const char c : line) {
        if (c == ',') {
          out.emplace_back();
        } else {
          out.back() += c;
        }
      }
      return out;
    };
    std::string line;
    std::getline(lines, line);
    const auto names = cells(line);
    std::map<std::string, std::vector<std::string>> out;
    while (std::getline(lines, line)) {
      const auto row = cells(line);
      EXPECT_EQ(row.size(), names.size()) << line;
      for (std::size_t i = 0; i < names.size(); ++i) out[names[i]].push_back(row.at(i));
    }
    EXPECT_EQ(out.size(), names.size()) << "two columns have one name";
    return out;
  }
};

using Cells = std::vector<std::string>;

TEST_F(RunCsvTest, IsExactAndInPieces) {
  algo::Telemetry odd;
  odd.tick = 1;
  odd.observation.stamp = 0.1;
  odd.observation.odometry.pose = {1e-9, -3, 0.001};
  odd.command.base = {1.0 / 3.0, 1.0 / 3.0};
  odd.clearance = std::nan("");
  odd.hold.name = "stopped";
  odd.behaviour = "avoid";
  algo::Telemetry free = odd;
  free.tick = 2;
  free.observation.stamp = 0.052;
  free.observation.odometry.pose = {0.2, -0.4, 0.002};
  free.observation.odometry.twist = {0.1, 1.0 / 3.0};
  free.command.base = {0.5, 1.0 / 3.0};
  free.clearance = 0.65;
  free.hold = {};
  const db::RunId run = stored(paper_robot(), {odd, free});
  const std::string csv = whole(run, 100);
  // The columns that scripts know stay where they are.
  EXPECT_THAT(
      csv,
      testing::StartsWith("tick,t,x,y,heading,v,omega,clearance,hold,behaviour,odometry.stamp,"
                          "odometry.v,odometry.omega,mission,"));
  EXPECT_THAT(csv,
              testing::HasSubstr("\n1,0.1,1e-09,-3,0.001,0.3333333333333333,0.3333333333333333,,"
                                 "stopped,avoid,0,0,0,idle,"));
  EXPECT_THAT(
      csv,
      testing::HasSubstr("\n2,0.052,0.2,-0.4,0.002,0.5,0.3333333333333333,0.65,none,avoid,0,"
                         "0.1,0.3333333333333333,idle,"));
  EXPECT_EQ(whole(run, 1), csv);
}

TEST_F(RunCsvTest, ChannelsAreColumnsWithACellWhereThereIsAReading) {
  algo::RobotSpec robot = paper_robot();
  robot.channels = {{.name = "battery.voltage", .unit = "V"}, {.name = "field", .values = 2}};
  std::vector<algo::Telemetry> ticks(3);
  for (std::uint64_t tick = 0; tick < 3; ++tick) ticks[tick].tick = tick;
  ticks[1].observation.channels.append() = {.channel = 1, .stamp = 0, .values = {1.0 / 3.0, -2}};
  ticks[2].observation.channels.append() = {.channel = 0, .stamp = 0, .values = {24.5}};
  const db::RunId run = stored(robot, ticks);
  for (const std::size_t limit : {1U, 2U, 100U}) {
    const std::string csv = whole(run, limit);
    EXPECT_THAT(csv,
                testing::StartsWith("tick,t,x,y,heading,v,omega,clearance,hold,behaviour,"
                                    "battery.voltage,field[0],field[1],odometry.stamp,"));
    auto cells = table(csv);
    EXPECT_EQ(cells["battery.voltage"], (Cells{"", "", "24.5"}));
    EXPECT_EQ(cells["field[0]"], (Cells{"", "0.3333333333333333", ""}));
    EXPECT_EQ(cells["field[1]"], (Cells{"", "-2", ""}));
  }
}

TEST_F(RunCsvTest, EverySingleValueOfAFrameHasItsColumn) {
  std::vector<algo::Telemetry> ticks(2);
  algo::Telemetry& t = ticks[1];
  t.tick = 1;
  t.mission = algo::Mission::Driving;
  t.observation.halt = algo::Halt::BatteryLow;
  t.limit.name = "turnover";
  t.output.waits = true;
  t.output.state = 3;
  t.goal = algo::SetGoal{{3.5, -1.25}, 0.5};
  t.goals_ahead.push_back({{1, 1}, {}});
  t.ground_truth = {.pose = {0.1, 0.2, 0.3},
                    .obstacle_distance = 1.5,
                    .clearance = -0.05,
                    .collided = true,
                    .tilt = algo::Tilt{0.01, 0.02, 0.03},
                    .fallen = true};
  t.observation.gyro = {0.01, 0.125};
  t.observation.inclinometer = {0.02, 0.25, -0.5};
  t.observation.encoders = {0.03, 7, 4294967295U};
  t.observation.line.fresh = true;
  t.observation.line.stamp = 0.04;
  t.observation.line.pixels.push_back({-12.5F, 3.0F});
  t.observation.line.pixels.push_back({7.0F, 2.25F});
  t.observation.floor = {0.05, 0.28, std::nan(""), 0.2, 0.205};
  t.requests.push_back(algo::ClearGoal{});
  t.requests.push_back(algo::Stop{false});
  t.requests.push_back(algo::SetGoals{});
  t.requests.push_back(algo::ChangeObstacle{});
  t.requests.push_back(algo::Joystick{0.5, -0.25, algo::StickMode::Elastic, 0.125, "Ann"});
  t.command.joints = 2;
  t.command.joint_rates = {0.5, -0.5};
  auto cells = table(whole(stored(paper_robot(), ticks), 100));
  const std::map<std::string, Cells> wanted = {
      {"mission", {"idle", "driving"}},
      {"halt", {"none", "battery_low"}},
      {"limit", {"", "turnover"}},
      {"waits", {"0", "1"}},
      {"state", {"0", "3"}},
      {"goal.x", {"", "3.5"}},
      {"goal.y", {"", "-1.25"}},
      {"goal.heading", {"", "0.5"}},
      {"goals_ahead", {"0", "1"}},
      {"truth.x", {"", "0.1"}},
      {"truth.y", {"", "0.2"}},
      {"truth.heading", {"", "0.3"}},
      {"truth.obstacle_distance", {"", "1.5"}},
      {"truth.clearance", {"", "-0.05"}},
      {"truth.collided", {"", "1"}},
      {"truth.overturned", {"", "0"}},
      {"truth.fallen", {"", "1"}},
      {"truth.z", {"", "0.01"}},
      {"truth.roll", {"", "0.02"}},
      {"truth.pitch", {"", "0.03"}},
      {"gyro.stamp", {"", "0.01"}},
      {"gyro.rate", {"", "0.125"}},
      {"inclinometer.stamp", {"", "0.02"}},
      {"inclinometer.roll", {"", "0.25"}},
      {"inclinometer.pitch", {"", "-0.5"}},
      {"encoders.stamp", {"", "0.03"}},
      {"encoders.left", {"", "7"}},
      {"encoders.right", {"", "4294967295"}},
      {"line.stamp", {"", "0.04"}},
      {"line.points", {"", "2"}},
      {"floor.stamp", {"", "0.05"}},
      {"floor.far_left", {"", "0.28"}},
      {"floor.far_right", {"", "inf"}},
      {"floor.near_left", {"", "0.2"}},
      {"floor.near_right", {"", "0.205"}},
      {"requests", {"", "clear_goal stop set_goals change_obstacle joystick"}},
      {"stick.forward", {"", "0.5"}},
      {"stick.turn", {"", "-0.25"}},
      {"stick.mode", {"", "elastic"}},
      {"stick.round_trip", {"", "0.125"}},
      {"stick.driver", {"", "Ann"}},
      {"joint_rate[0]", {"", "0.5"}},
      {"joint_rate[1]", {"", "-0.5"}},
  };
  for (const auto& [name, column] : wanted) EXPECT_EQ(cells[name], column) << name;
}

TEST_F(RunCsvTest, MeasuresAreColumnsByNameAlsoBeforeTheirLegend) {
  std::vector<algo::Telemetry> ticks(4);
  for (std::uint64_t tick = 0; tick < 4; ++tick) ticks[tick].tick = tick;
  const auto measure = [&](std::size_t tick, std::uint32_t legend, bool fresh) -> algo::Telemetry& {
    ticks[tick].legend = legend;
    ticks[tick].legend_fresh = fresh;
    return ticks[tick];
  };
  measure(0, 7, false).output.measures.push_back({"strip.left", "m", 0.5});
  measure(1, 7, true).output.measures.push_back({"strip.left", "m", std::nan("")});
  measure(2, 8, true)
      .output.measures.push_back({"plan.length", "m", 40.25});  // too wide for 16 bits
  ticks[2].output.measures.push_back({"strip.left", "m", -0.25});
  const db::RunId run = stored(paper_robot(), ticks);
  auto cells = table(whole(run, 2));
  EXPECT_EQ(cells["strip.left"], (Cells{"0.5", "", "-0.25", ""}));
  EXPECT_EQ(cells["plan.length"], (Cells{"", "", "40.25", ""}));
  EXPECT_THAT(whole(run, 2), testing::HasSubstr(",strip.left,plan.length\n"));
}

TEST_F(RunCsvTest, WordsWithCommasAndQuotesAreQuoted) {
  std::vector<algo::Telemetry> ticks(1);
  ticks[0].words = {"Passing \"the\" left obstacle, on its right", "Two\nlines."};
  ticks[0].words_fresh = true;
  EXPECT_THAT(
      whole(stored(paper_robot(), ticks), 1),
      testing::EndsWith(",\"Passing \"\"the\"\" left obstacle, on its right\",\"Two lines.\"\n"));
}

TEST_F(RunCsvTest, UnitsStandInTheHeaderWhenAskedFor) {
  algo::RobotSpec robot = paper_robot();
  robot.channels = {{.name = "battery.voltage", .unit = "V"}, {.name = "field", .values = 2}};
  const db::RunId run = stored(robot, std::vector<algo::Telemetry>(1));
  EXPECT_THAT(whole(run, 1, {.units = true}),
              testing::StartsWith("tick,t [s],x [m],y [m],heading [rad],v [m/s],omega [rad/s],"
                                  "clearance [m],hold,behaviour,battery.voltage [V],field[0],"
                                  "field[1],odometry.stamp [s],odometry.v [m/s],"));
}

TEST_F(RunCsvTest, RingsAreColumnsByTheirMounts) {
  std::vector<algo::Telemetry> ticks(2);
  const algo::Pose2 left{0.1, 0.1, 0.5};
  const algo::Pose2 right{0.1, -0.1, -0.5};
  ticks[0].observation.sonar.push_back({right, 0, 1.5, 5, algo::Beam::Ok});
  ticks[1].tick = 1;
  ticks[1].observation.sonar.push_back({left, 0, 0, 5, algo::Beam::Free});
  ticks[1].observation.sonar.push_back({right, 0, 0, 5, algo::Beam::Invalid});
  ticks[1].observation.bumpers.push_back({left, 0, true});
  auto cells = table(whole(stored(paper_robot(), ticks), 1));
  EXPECT_EQ(cells["sonar[0]"], (Cells{"1.5", "nan"}));
  EXPECT_EQ(cells["sonar[1]"], (Cells{"", "inf"}));
  EXPECT_EQ(cells["bumper[0]"], (Cells{"", "1"}));
}

TEST_F(RunCsvTest, ScansAndMovedObstaclesComeOnlyWhenAskedFor) {
  std::vector<algo::Telemetry> ticks(2);
  ticks[1].tick = 1;
  algo::LaserScan& scan = ticks[1].observation.scans.append();
  scan.stamp = 0.5;
  scan.angle_min = -1.5;
  scan.angle_increment = 0.25;
  scan.range_max = 8;
  scan.resize(3);
  scan.set_ok(0, 1.234);
  scan.set_free(1);
  scan.set_invalid(2, algo::BeamCode::Dazzled);
  ticks[1].observation.infrared.push_back({{0.1, 0, -0.5}, 0, 1.5, 3, algo::Beam::Ok});
  ticks[1].observation.infrared.push_back({{0.1, 0, 0.5}, 0, 0, 3, algo::Beam::Free});
  ticks[1].moved.push_back({4, {0.5, -0.25, 1}});
  ticks[1].moved.push_back({5, {1, 2, 0}});
  const db::RunId run = stored(paper_robot(), ticks);
  auto cells = table(whole(run, 1, {.arrays = true}));
  EXPECT_EQ(cells["scan[0].stamp"], (Cells{"", "0.5"}));
  EXPECT_EQ(cells["scan[0].angle_min"], (Cells{"", "-1.5"}));
  EXPECT_EQ(cells["scan[0].angle_increment"], (Cells{"", "0.25"}));
  EXPECT_EQ(cells["scan[0].ranges"], (Cells{"", "1.234 inf nan"}));
  EXPECT_EQ(cells["infrared"], (Cells{"", "0.1 0 -0.5 1.5; 0.1 0 0.5 inf"}));
  EXPECT_EQ(cells["moved"], (Cells{"", "4 0.5 -0.25 1; 5 1 2 0"}));
  auto plain = table(whole(run, 1));
  EXPECT_EQ(plain["scans"], (Cells{"0", "1"}));
  EXPECT_EQ(plain.count("moved") + plain.count("infrared") + plain.count("scan[0].ranges"), 0U);
}

/// One scanner above the other: x, y and heading are the same.
TEST_F(RunCsvTest, ScannersAtOnePlaceHaveColumnsOfTheirOwn) {
  std::vector<algo::Telemetry> ticks(4);
  const auto scan = [&](std::size_t tick, double stamp, double range) {
    ticks[tick].tick = tick;
    algo::LaserScan& out = ticks[tick].observation.scans.append();
    out.stamp = stamp;
    out.angle_min = -0.25;
    out.angle_increment = 0.5;
    out.range_max = 8;
    out.turn_period = 0.01;
    out.turns = 2;
    out.resize(2);
    out.set_ok(0, range);
    out.set_ok(1, range);
  };
  ticks[0].tick = 0;
  scan(1, 0.016, 5);  // the upper one alone, at first
  scan(2, 0.030, 1);
  scan(2, 0.036, 5);
  scan(3, 0.050, 1);
  auto cells = table(whole(stored(paper_robot(), ticks), 1, {.arrays = true}));
  EXPECT_EQ(cells["scan[0].stamp"], (Cells{"", "", "0.03", "0.05"}));
  EXPECT_EQ(cells["scan[0].ranges"], (Cells{"", "", "1 1", "1 1"}));
  EXPECT_EQ(cells["scan[1].stamp"], (Cells{"", "0.016", "0.036", ""}));
  EXPECT_EQ(cells["scan[1].ranges"], (Cells{"", "5 5", "5 5", ""}));
}

TEST_F(RunCsvTest, AChannelWithTheNameOfAColumnIsNamedApart) {
  algo::RobotSpec robot = paper_robot();
  robot.channels = {{.name = "x"}, {.name = "odometry.v"}, {.name = "sonar", .values = 2}};
  robot.channels.push_back({.name = "battery"});
  std::vector<algo::Telemetry> ticks(1);
  ticks[0].observation.channels.append() = {.channel = 0, .stamp = 0, .values = {7.5}};
  auto cells = table(whole(stored(robot, ticks), 1, {.arrays = true}));
  EXPECT_EQ(cells["channel.x"], Cells{"7.5"});
  EXPECT_EQ(cells["channel.odometry.v"], Cells{""});
  EXPECT_EQ(cells["channel.sonar[1]"], Cells{""});
  EXPECT_EQ(cells["battery"], Cells{""});
  EXPECT_EQ(cells["x"], Cells{"0"});
}

}  // namespace
}  // namespace server
