// tests/server/lab/map_study_test.cpp: path errors worked out by hand, and a small log mapped.
#include "server/lab/mapping/map_study.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace server::mapping {
namespace {

namespace fs = std::filesystem;
using algo::Pose2;

/// `count` poses at steps of 1 m, each turned by `turn` from the previous one.
std::vector<Pose2> straight(int count, double scale = 1) {
  std::vector<Pose2> path;
  for (int k = 0; k < count; ++k) path.push_back({scale * k, 0, 0});
  return path;
}

TEST(PathError, AScaleErrorIsThatShareOfThePiece) {
  // 21 poses: a piece of 10 m from each of the first 11, estimated 10.2 m; the end 0.4 m off.
  const PathError error = path_error(straight(21), straight(21, 1.02));
  EXPECT_EQ(error.pieces, 11U);
  EXPECT_NEAR(error.rms_10m, 0.2, 1e-12);
  EXPECT_NEAR(error.end, 0.4, 1e-12);
  // 0.02 k off at pose k: the mean square of 0 to 20 is 20 * 41 / 6.
  EXPECT_NEAR(error.rms, 0.02 * std::sqrt(20 * 41 / 6.0), 1e-12);
  EXPECT_NEAR(error.turn_10m, 0, 1e-12);
}

TEST(PathError, EarlierErrorsDoNotCountForAPiece) {
  std::vector<Pose2> bent = straight(21);
  for (Pose2& pose : bent) pose = algo::compose({0, 0, 0.3}, pose);
  const PathError error = path_error(straight(21), bent);
  EXPECT_NEAR(error.rms_10m, 0, 1e-12);
  EXPECT_NEAR(error.end, 2 * 20 * std::sin(0.15), 1e-12);
}

TEST(PathError, AShortPathHasNoPieces) {
  const PathError error = path_error(straight(5), straight(5, 2));
  EXPECT_EQ(error.pieces, 0U);
  EXPECT_EQ(error.rms_10m, 0);
  EXPECT_NEAR(error.end, 4, 1e-12);
  EXPECT_NEAR(path_length(straight(5)), 4, 1e-12);
  EXPECT_THROW(path_error(straight(5), straight(4)), std::invalid_argument);
}

/// Scans of a wall 2 m ahead from a drive along it.
std::vector<algo::LaserScan> scans_of_a_wall(std::size_t count) {
  algo::LaserScan scan;
  scan.angle_min = std::numbers::pi / 2 - 0.5;
  scan.angle_increment = 0.01;
  for (int i = 0; i <= 100; ++i) {
    scan.ranges.push_back(2 / std::cos(0.01 * i - 0.5));
    scan.status.push_back(algo::Beam::Ok);
  }
  return std::vector<algo::LaserScan>(count, scan);
}

TEST(WallCells, AreFewerAlongTheTruerPath) {
  std::vector<Pose2> truth;
  std::vector<Pose2> shaky;
  for (int k = 0; k < 250; ++k) {
    truth.push_back({0.1 * k, 0.02, 0});
    shaky.push_back({0.1 * k, 0.02, k % 2 == 0 ? 0.02 : -0.02});
  }
  const auto scans = scans_of_a_wall(truth.size());
  const auto sharp = wall_cells(scans, truth, truth);
  const auto blunt = wall_cells(scans, shaky, truth);
  ASSERT_EQ(sharp.size(), 3U);  // of 10, 10 and 5 m
  ASSERT_EQ(blunt.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_GT(blunt[i], sharp[i] + sharp[i] / 2);
}

/// A robot that drives along a corridor with doors, 180 readings a scan.
std::string corridor_log(int scans) {
  std::ostringstream log;
  for (int k = 0; k < scans; ++k) {
    const double x = 0.2 * k;
    log << "FLASER 180";
    for (int i = 0; i < 180; ++i) {
      const double a = (i - 90) * std::numbers::pi / 180;
      const double side = std::abs(std::sin(a)) > 1e-9 ? 1.0 / std::abs(std::sin(a)) : 1e9;
      const double at = x + side * std::cos(a);
      // Doors, 0.5 m deep, at places no other stretch has.
      const bool door = std::fmod(at * at, 7.0) < 1.5;
      const double range = door ? 1.5 * side : side;
      log << ' ' << std::min(range, 15.0);
    }
    log << ' ' << x << " 0 0 " << x << " 0 0 " << 0.2 * k << " host " << 0.2 * k << '\n';
  }
  return log.str();
}

class MapStudyOfALog : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    std::ofstream(folder_ / "corridor.log") << corridor_log(80);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_ =
      fs::temp_directory_path() / ("tautline_map_study_" + std::to_string(::getpid()));
};

TEST_F(MapStudyOfALog, WithoutErrorsThePathIsTheLogs) {
  const Recording log = read_recording(folder_ / "corridor.log");
  EXPECT_EQ(log.name, "corridor");
  ASSERT_EQ(log.scans.size(), 80U);
  const MapStudy study = study_map(log, {});
  ASSERT_EQ(study.runs.size(), 1U);
  EXPECT_NEAR(study.runs[0].odometry.end, 0, 1e-9);
  EXPECT_TRUE(study.runs[0].matched_W.empty());
  const nlohmann::json json = to_json(study);
  EXPECT_NEAR(json["length_m"], 15.8, 1e-9);
  EXPECT_FALSE(json["runs"][0].contains("matched"));
}

TEST_F(MapStudyOfALog, EachSeedGivesItsOwnErrorsAndRepeatsThem) {
  const Recording log = read_recording(folder_ / "corridor.log");
  MapOptions options;
  options.errors = {.odometry_scale = 0.02, .odometry_noise = 0.01, .odometry_slip = 0.05};
  options.seeds = 3;
  options.match = true;
  options.threads = 2;
  const MapStudy study = study_map(log, options);
  ASSERT_EQ(study.runs.size(), 3U);
  EXPECT_NE(study.runs[0].odometry.end, study.runs[1].odometry.end);
  for (const MapRun& run : study.runs) {
    EXPECT_GT(run.odometry.end, 0.1);
    EXPECT_EQ(run.matched_W.size(), log.scans.size());
    EXPECT_GT(run.matched.pieces, 0U);
  }
  options.threads = 1;
  const MapStudy again = study_map(log, options);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(again.runs[i].matched_W, study.runs[i].matched_W);
  }
}

TEST_F(MapStudyOfALog, ThePageKeepsTheTextAroundTheTables) {
  const fs::path page = folder_ / "docs" / "mapping.md";
  fs::create_directories(page.parent_path());
  std::ofstream(page) << "# Maps\n\nBefore.\n";
  MapOptions options;
  options.match = true;
  std::vector<MapStudy> studies{study_map(read_recording(folder_ / "corridor.log"), options)};
  write_markdown(studies, page);
  std::ostringstream first;
  first << std::ifstream(page).rdbuf();
  EXPECT_THAT(first.str(), testing::StartsWith("# Maps\n\nBefore.\n"));
  EXPECT_THAT(first.str(), testing::HasSubstr("pictures/mapping/corridor-matched.svg"));
  EXPECT_TRUE(fs::exists(page.parent_path() / "pictures/mapping/corridor-odometry.svg"));
  std::ostringstream picture;
  picture << std::ifstream(page.parent_path() / "pictures/mapping/corridor-matched.svg").rdbuf();
  EXPECT_THAT(picture.str(), testing::StartsWith("<svg "));
  EXPECT_THAT(picture.str(), testing::EndsWith("</svg>\n"));
}

TEST_F(MapStudyOfALog, ErrorsAreSentences) {
  EXPECT_THROW(read_recording(folder_ / "nothing.log"), std::runtime_error);
  MapOptions options;
  options.errors.odometry_slip = 1;
  EXPECT_THROW(study_map(read_recording(folder_ / "corridor.log"), options), std::invalid_argument);
}

}  // namespace
}  // namespace server::mapping
