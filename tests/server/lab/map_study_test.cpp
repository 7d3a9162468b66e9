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

TEST_F(MapStudyOfALog, PosesAndRelationsAreOfTheMatchedPath) {
  const Recording log = read_recording(folder_ / "corridor.log");
  std::ofstream(folder_ / "corridor.relations") << "0.4 2.0 1.6 0 0 0 0 0\n\n0 12.0 12 0 0 0 0 0\n";
  MapOptions options;
  options.match = true;
  options.errors.odometry_scale = 0.05;
  options.relations = read_relations(folder_ / "corridor.relations", log.stamps);
  ASSERT_EQ(options.relations.size(), 2U);
  EXPECT_EQ(options.relations[0].from, 2U);
  EXPECT_EQ(options.relations[0].to, 10U);
  const MapStudy study = study_map(log, options);
  const nlohmann::json json = to_json(study);
  const std::vector<Pose2>& path_W = study.runs[0].matched_W;
  const double first =
      (algo::pose_step(path_W[2], path_W[10]).position() - algo::Vec2(1.6, 0)).norm();
  const double second =
      (algo::pose_step(path_W[0], path_W[60]).position() - algo::Vec2(12, 0)).norm();
  EXPECT_NEAR(json["translation_mean_m"], (first + second) / 2, 1e-9);
  EXPECT_NEAR(json["translation_sd_m"], std::abs(first - second) / 2, 1e-9);
  EXPECT_TRUE(json.contains("rotation_mean_rad") && json.contains("rotation_sd_rad"));
  EXPECT_EQ(to_json(std::vector{study}), json);
  EXPECT_EQ(to_json(std::vector{study, study}), nlohmann::json::array({json, json}));
  write_poses(study, folder_ / "out.txt");
  std::ifstream poses(folder_ / "out.txt");
  double stamp = 0;
  Pose2 pose;
  std::size_t lines = 0;
  while (poses >> stamp >> pose.x >> pose.y >> pose.heading) {
    EXPECT_NEAR(stamp, 0.2 * static_cast<double>(lines), 1e-6);
    EXPECT_NEAR(pose.x, path_W[lines].x, 1e-6);
    ++lines;
  }
  EXPECT_EQ(lines, 80U);
}

TEST_F(MapStudyOfALog, BadRelationsAreSentences) {
  const std::vector<double> stamps{10, 11, 12};
  const auto complaint = [&](const std::string& text) -> std::string {
    std::ofstream(folder_ / "bad.relations") << text;
    try {
      read_relations(folder_ / "bad.relations", stamps);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(complaint("10 11 1 0 0 0 0 0\n# 1\n"), "");
  EXPECT_THAT(complaint(""), testing::HasSubstr("holds no relation"));
  EXPECT_THAT(complaint("10 11 1 0 0 0 0\n"), testing::HasSubstr("Line 1 of bad.relations"));
  EXPECT_THAT(complaint("\n10 11 1 nan 0 0 0 0\n"), testing::HasSubstr("Line 2"));
  EXPECT_THAT(complaint("10 11 1 0 0 0 0 0 9\n"), testing::HasSubstr("more than the eight"));
  EXPECT_THAT(complaint("10 14 1 0 0 0 0 0\n"), testing::HasSubstr("nearest scan is 2 s away"));
  EXPECT_THROW(read_relations(folder_ / "none", stamps), std::runtime_error);
  std::ofstream(folder_ / "good.relations") << "0 0 1 0 0 0 0 0\n";
  EXPECT_THROW(read_relations(folder_ / "good.relations", std::vector<double>{0, 0}),
               std::runtime_error);
}

TEST_F(MapStudyOfALog, ErrorsAreSentences) {
  EXPECT_THROW(read_recording(folder_ / "nothing.log"), std::runtime_error);
  std::ofstream(folder_ / "jump.log") << "FLASER 2 1 1 0 0 0 0 0 0 1 host 1\n"
                                         "FLASER 2 1 1 9e8 0 0 9e8 0 0 2 host 2\n";
  EXPECT_THROW(read_recording(folder_ / "jump.log"), std::runtime_error);
  MapOptions options;
  options.errors.odometry_slip = 1;
  EXPECT_THROW(study_map(read_recording(folder_ / "corridor.log"), options), std::invalid_argument);
}

}  // namespace
}  // namespace server::mapping
