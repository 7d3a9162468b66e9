// tests/sim/replay_data_test.cpp: the recorded logs, reading by reading against the raw text.
#include <cmath>
#include <fstream>
#include <sstream>
#include <vector>

#include "tests/folders.hpp"
#include <gtest/gtest.h>

#include "sim/replay.hpp"

namespace sim {
namespace {

struct RecordedLog {
  std::string file{};
  std::size_t scans = 0, beams = 0;
  double step_degrees = 0;
  CarmenUnit unit{};
  double first_code = 0;  // [m] readings from here on are no distances (README of the data)
  double share = 0;       // of non-measurements
  double period = 0;      // [s] median
};
class RecordedLogs : public testing::TestWithParam<RecordedLog> {};

TEST_P(RecordedLogs, EveryScanEqualsTheTextToTheMillimetre) {
  const RecordedLog& log = GetParam();
  const std::string path = (tests::shared_data() / "laser" / log.file).string();
  Replay robot{std::filesystem::path(path)};
  EXPECT_EQ(robot.size(), log.scans);
  EXPECT_EQ(robot.unit(), log.unit);
  EXPECT_EQ(robot.damage(), "");
  EXPECT_NEAR(robot.spec().period, log.period, 0.02);

  std::ifstream text(path);
  std::string line;
  algo::Observation seen;
  std::size_t scans = 0;
  std::size_t masked = 0;
  double last_stamp = -1;
  while (std::getline(text, line)) {
    if (line.rfind("FLASER ", 0) != 0) continue;
    if (scans == 0) {
      robot.reset(seen);
    } else {
      ASSERT_TRUE(robot.step({}, seen));
    }
    ++scans;
    std::istringstream fields(line);
    std::string name;
    std::size_t n = 0;
    fields >> name >> n;
    ASSERT_EQ(seen.scans.size(), 1u);
    const algo::LaserScan& scan = seen.scans[0];
    ASSERT_EQ(scan.size(), n);
    ASSERT_EQ(n, log.beams);
    ASSERT_NEAR(scan.angle_increment * 180 / M_PI, log.step_degrees, 1e-9);
    ASSERT_GT(seen.stamp, last_stamp);
    last_stamp = seen.stamp;
    for (std::size_t i = 0; i < n; ++i) {
      double reading = 0;
      fields >> reading;
      if (reading >= log.first_code) {
        ++masked;
        ASSERT_NE(scan.status[i], algo::Beam::Ok) << line.substr(0, 20) << " beam " << i;
        const auto raw = static_cast<int>(
            std::lround(reading * (log.unit == CarmenUnit::Centimetre ? 100 : 1000)));
        ASSERT_EQ(static_cast<int>(scan.codes[i]), raw % 16);
        ASSERT_EQ(scan.status[i] == algo::Beam::Free, raw % 16 == 7);
      } else {
        ASSERT_EQ(scan.status[i], algo::Beam::Ok);
        ASSERT_NEAR(scan.ranges[i], reading, 1e-9);
      }
    }
    double pose[6];
    for (double& value : pose) fields >> value;
    ASSERT_NEAR(seen.odometry.pose.x, pose[3], 1e-12);
    ASSERT_NEAR(seen.odometry.pose.y, pose[4], 1e-12);
    ASSERT_NEAR(std::remainder(seen.odometry.pose.heading - pose[5], 2 * M_PI), 0, 1e-9);
  }
  EXPECT_EQ(scans, log.scans);
  EXPECT_NEAR(
      static_cast<double>(masked) / static_cast<double>(scans * log.beams), log.share, 0.00006);
  EXPECT_FALSE(robot.step({}, seen));
}

// The figures are those of the data's README.
INSTANTIATE_TEST_SUITE_P(
    Carmen,
    RecordedLogs,
    testing::Values(
        RecordedLog{"freiburg-079-first2000.log",
                    2000,
                    360,
                    0.5,
                    CarmenUnit::Centimetre,
                    81.8,
                    0.0230,
                    0.23},
        RecordedLog{"intel-corrected.log", 910, 180, 1, CarmenUnit::Centimetre, 81.8, 0.0255, 3.35},
        RecordedLog{"orebro-corrected.log",
                    237,
                    181,
                    1,
                    CarmenUnit::Millimetre32m,
                    32.755,
                    0.0226,
                    Replay::kFallbackPeriod}));

}  // namespace
}  // namespace sim
