// tests/server/cli/doctor_test.cpp: the doctor's findings about missing ports and spikes; a scan as
// a line of a log.
#include "server/cli/doctor.hpp"

#include <chrono>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/server/cli/parsed.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "server/cli/carmen_line.hpp"
#include "server/cli/cli.hpp"
#include "server/cli/doctor_floor.hpp"
#include "server/emulate/emulation.hpp"
#include "sim/replay.hpp"

namespace server {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(Doctor, MissingPortsAreBadWithAdvice) {
  const drivers::RobotFile file = drivers::parse_robot(R"(name = "none"
hull = { radius = 0.3 }
[[laser]]
port = "/dev/no_such_laser"
[base]
type = "pioneer"
port = "/dev/no_such_base"
track = 0.33
)",
                                                       "none.toml");
  std::vector<Finding> findings;
  EXPECT_FALSE(examine(file, {}, [&](const Finding& f) { findings.push_back(f); }));
  std::vector<Finding> bad;
  for (const Finding& f : findings) {
    if (f.verdict == Finding::Verdict::Bad) bad.push_back(f);
  }
  ASSERT_EQ(bad.size(), 2U);
  EXPECT_THAT(bad[0].sentence, HasSubstr("/dev/no_such_laser"));
  EXPECT_EQ(bad[1].device, "base");
  for (const Finding& f : bad) EXPECT_THAT(f.advice, HasSubstr("fuser /dev/no_such_"));
}

/// The findings about an emulated scanner after `command`; expects a bad one.
std::string bad_words_after(const std::string& command) {
  namespace fs = std::filesystem;
  const fs::path folder =
      fs::temp_directory_path() / ("tautline_doctor_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  emulate::EmulationOptions options;
  options.scanner_links = {folder / "scanner"};
  emulate::Emulation emulation(options);
  emulation.start();
  emulation.command(command);
  const drivers::RobotFile file = drivers::parse_robot(
      "name = \"a\"\nhull = { radius = 0.3 }\n[[laser]]\nport = \"" +
          (folder / "scanner").string() +
          "\"\n[base]\ntype = \"pioneer\"\nport = \"/dev/no_such_base\"\ntrack = 0.33\n",
      "a.toml");
  std::string bad;
  const auto listen = [&bad](const Finding& f) {
    if (f.verdict == Finding::Verdict::Bad && f.device == "laser 1") bad += f.sentence + "\n";
    EXPECT_THAT(f.sentence, Not(HasSubstr("% of the beams meet something")));
  };
  EXPECT_FALSE(examine(file, {.measuring = 0.5}, listen));
  fs::remove_all(folder);
  return bad;
}

TEST(Doctor, ADazzledScannerIsAlwaysBad) {
  EXPECT_THAT(bad_words_after("dazzle on"), HasSubstr("It is blinded"));
  EXPECT_THAT(bad_words_after("cone 20"), HasSubstr("It is dazzled"));
}

TEST(Doctor, AnInterruptionStopsTheWheels) {
  namespace fs = std::filesystem;
  const fs::path folder =
      fs::temp_directory_path() / ("tautline_doctor_move_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  emulate::EmulationOptions options;
  options.base = emulate::BaseKind::P2os;
  options.base_link = folder / "base";
  emulate::Emulation emulation(options);
  emulation.start();
  const auto x = [&] {
    return nlohmann::json::parse(emulation.command("truth"))["pose"][0].get<double>();
  };
  const drivers::RobotFile file = drivers::parse_robot(
      "name = \"a\"\nhull = { radius = 0.3 }\n[base]\ntype = \"pioneer\"\ntrack = 0.33\nport = \"" +
          options.base_link.string() + "\"\n",
      "a.toml");
  const DoctorOptions interrupted{.move = true, .interrupted = [&] { return x() > 0.01; }};
  EXPECT_THROW(examine(file, interrupted, [](const Finding&) {}), std::runtime_error);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  const double stopped = x();
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_NEAR(x(), stopped, 1e-3);
  fs::remove_all(folder);
}

TEST(Lms200Log, AFullDiskIsSaid) {
  namespace fs = std::filesystem;
  const fs::path link =
      fs::temp_directory_path() / ("tautline_lms200_log_" + std::to_string(::getpid()));
  emulate::EmulationOptions options;
  options.scanner_links = {link};
  emulate::Emulation emulation(options);
  emulation.start();
  testing::internal::CaptureStderr();
  const tests::Parsed log = tests::parsed(
      add_lms200_command, {"lms200", "log", link.string(), "--out", "/dev/full", "--scans", "1"});
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("is the disk full?"));
  EXPECT_EQ(log.status, kNotWell);
}

/// The findings about emulated floor sensors after `command`.
std::string floor_words_after(const std::string& command, bool well) {
  namespace fs = std::filesystem;
  const fs::path folder =
      fs::temp_directory_path() / ("tautline_doctor_psd_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  emulate::EmulationOptions options;
  options.psd_link = folder / "psd";
  emulate::Emulation emulation(options);
  emulation.start();
  emulation.command(command);
  const drivers::RobotFile file = drivers::parse_robot(
      "name = \"a\"\nhull = { radius = 0.3 }\n[base]\ntype = \"pioneer\"\n"
      "port = \"/dev/no_such_base\"\ntrack = 0.33\n[psd]\nx = 0.3\nheight = 0.1414\n"
      "half_spacing = 0.1\nport = \"" +
          options.psd_link.string() + "\"\n",
      "a.toml");
  std::string words;
  bool bad = false;
  const auto listen = [&](const Finding& f) {
    if (f.device != "floor sensors") return;
    words += f.sentence + "\n";
    bad = bad || f.verdict == Finding::Verdict::Bad;
  };
  EXPECT_FALSE(examine(file, {.patience = 4, .measuring = 0.5}, listen));  // it has no base
  EXPECT_EQ(bad, !well) << words;
  fs::remove_all(folder);
  return words;
}

TEST(Doctor, FloorSensorsAreReadAndTheirFaultsAreBad) {
  const std::string well = floor_words_after("truth", true);
  EXPECT_THAT(well, HasSubstr("readings a second arrive."));
  EXPECT_THAT(well, HasSubstr("The far left sensor sees the floor at 0.2"));
  const std::string stuck = floor_words_after("stick 2", false);
  EXPECT_THAT(stuck, HasSubstr("The far right sensor is stuck"));
  EXPECT_THAT(stuck, Not(HasSubstr("sees the floor")));
  EXPECT_THAT(floor_words_after("psd drop 0.5", false), HasSubstr("no whole line"));
}

TEST(Doctor, FloorSensorsThatSeeNoLevelFloorAreNoted) {
  const algo::FloorSensors sensors{0.3, 0.2, 0.1, std::numbers::pi / 4, 0.08};  // near: 0.283 m
  const algo::DeviceReport report{.facts = {{"far left", "0.363 m (0.74 V)"},
                                            {"far right", "0.361 m (0.74 V)"},
                                            {"near left", "0.200 m (1.26 V)"},
                                            {"near right", "nothing within range (0.10 V)"}}};
  const algo::FloorRanges seen{0, 0.363, 0.361, 0.200, std::nan("")};
  std::vector<Finding> found;
  const doctor::Found listen = [&](const Finding& f) { found.push_back(f); };
  doctor::Notes notes("floor sensors", listen);
  doctor::look_at_distances(report, seen, sensors, notes);
  EXPECT_TRUE(notes.all_well()) << "it may stand anywhere";
  ASSERT_EQ(found.size(), 4U);
  EXPECT_EQ(found[1].sentence, "The far right sensor sees the floor at 0.361 m (0.74 V).");
  EXPECT_EQ(found[2].verdict, Finding::Verdict::Note);
  EXPECT_EQ(
      found[2].sentence,
      "The near left sensor sees something at 0.200 m (1.26 V); a level floor would be at 0.283 "
      "m.");
  EXPECT_EQ(found[3].sentence, "The near right sensor sees nothing within range (0.10 V).");
}

TEST(Doctor, SpikesDifferFromBothNeighbours) {
  EXPECT_EQ(count_spikes({2, 2, 2, 2}), 0U);
  EXPECT_EQ(count_spikes({2, 1, 2, 2}), 1U);
  EXPECT_EQ(count_spikes({2, 2, 4, 4}), 0U);  // an edge
  EXPECT_EQ(count_spikes({}), 0U);
}

TEST(Doctor, WheelsThatMoveOtherThanCommandedAreBad) {
  EXPECT_TRUE(drove_as_told(0.05, 0.05));
  EXPECT_TRUE(drove_as_told(-0.05, -0.045));
  EXPECT_FALSE(drove_as_told(0.05, -0.05));  // reversed
  EXPECT_FALSE(drove_as_told(0.05, 0.1));    // four counts a line taken for two
  EXPECT_FALSE(drove_as_told(0.05, 0.037));  // a gear of 26 taken for one of 19
  EXPECT_FALSE(drove_as_told(0.05, 0));
}

/// A written scan is readable by the log reader.
TEST(CarmenLine, IsReadBack) {
  for (const double field : {180.0, 100.0}) {
    algo::LaserScan scan;
    scan.resize(101);
    scan.range_max = 8.191;
    scan.angle_min = -field / 2 * std::numbers::pi / 180;
    scan.angle_increment = field / 100 * std::numbers::pi / 180;
    for (std::size_t i = 0; i < 101; ++i) scan.set_ok(i, 1.0 + 0.001 * static_cast<double>(i));
    scan.set_free(7);
    std::istringstream log(carmen_line(scan, "lab", 1000.5, 0.5) + "\n");
    sim::Replay replay(log, "test");
    algo::Observation seen;
    replay.reset(seen);
    ASSERT_EQ(seen.scans.size(), 1U);
    const algo::LaserScan& back = seen.scans[0];
    EXPECT_NEAR(back.angle_min, scan.angle_min, 1e-5);
    EXPECT_NEAR(back.angle_increment, scan.angle_increment, 1e-5);
    EXPECT_DOUBLE_EQ(back.ranges[100], 1.1);
    EXPECT_NE(back.status[7], algo::Beam::Ok);
  }
}

}  // namespace
}  // namespace server
