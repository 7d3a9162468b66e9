// tests/server/lab/map_data_test.cpp: part of a real log with added errors, matched;
// docs/mapping.md has the whole log.
#include <filesystem>

#include "tests/folders.hpp"
#include <gtest/gtest.h>

#include "server/lab/mapping/map_study.hpp"

namespace server::mapping {
namespace {

TEST(MapData, ScanMatchingCorrectsTheFreiburgMap) {
  constexpr std::size_t kScans = 700;
  const std::filesystem::path folder = tests::shared_data();
  Recording log = read_recording(folder / "laser/freiburg-079-first2000.log");
  ASSERT_EQ(log.scans.size(), 2000U);
  log.scans.resize(kScans);
  log.path_W.resize(kScans);
  MapOptions options;
  options.errors = {.odometry_scale = 0.02, .odometry_noise = 0.01, .odometry_slip = 0.05};
  options.match = true;
  options.seeds = 2;
  for (const MapRun& run : study_map(std::move(log), options).runs) {
    EXPECT_GT(run.odometry.end, 0.5) << run.seed;
    EXPECT_LT(run.matched.end, run.odometry.end / 2) << run.seed;
    EXPECT_LT(run.matched.rms_10m, run.odometry.rms_10m / 2) << run.seed;
  }
}

}  // namespace
}  // namespace server::mapping
