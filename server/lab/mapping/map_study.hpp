// server/lab/mapping/map_study.hpp: a recorded log, its poses spoilt as odometry would be, and what
// matching the scans makes good of it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "algo/mapping/mapper.hpp"
#include "server/experiment/pool.hpp"
#include "server/lab/mapping/path_error.hpp"
#include "server/lab/mapping/sharpness.hpp"
#include "sim/scenario.hpp"

namespace server::mapping {

/// All scans of a CARMEN log, and where its robot was when they were taken.
struct Recording {
  std::string name{};  // the file's, without folder and ending
  std::vector<algo::LaserScan> scans{};
  std::vector<algo::Pose2> path_W{};  // as long
};

/// Throws std::runtime_error with a sentence when there is no such file or no scan in it.
Recording read_recording(const std::filesystem::path& file);

struct MapOptions {
  sim::DriveConfig errors{};  // of the odometry: odometry_slip, odometry_scale, odometry_noise
  bool match = false;
  std::uint64_t first_seed = 1;
  std::size_t seeds = 1;
  unsigned threads = 0;  // 0: one a core
  experiment::Progress progress{};
};

/// One seed: the log's poses spoilt, and the path that was found from them.
struct MapRun {
  std::uint64_t seed = 0;
  std::vector<algo::Pose2> odometry_W{};
  std::vector<algo::Pose2> matched_W{};  // empty when matching was not asked for
  PathError odometry{};
  PathError matched{};
  std::vector<std::size_t> matched_cells{};  // see wall_cells(), as with the log's own
  double scan_time = 0;                      // [s] CPU, mean of placing a scan and entering it
};

struct MapStudy {
  Recording log{};
  MapOptions options{};
  std::vector<MapRun> runs{};            // one a seed
  std::vector<std::size_t> log_cells{};  // of the log's own poses; only with matching
};

/// Throws std::invalid_argument when the errors make no sense.
MapStudy study_map(Recording log, const MapOptions& options);

/// The map of the scans as if `path_W` were true.
algo::OccupancyMap map_along(const Recording& log, const std::vector<algo::Pose2>& path_W);

nlohmann::json to_json(const MapStudy& study);
std::string to_text(const MapStudy& study);

/// A picture of the map along `path_W`, with that path in it, as an SVG document.
std::string draw_map(const Recording& log,
                     const std::vector<algo::Pose2>& path_W,
                     const std::string& title);

/// Writes tables and pictures of all `studies` into `file`, in the place of those an earlier call
/// put there, and the pictures into pictures/mapping/ beside it. Throws std::runtime_error.
void write_markdown(const std::vector<MapStudy>& studies, const std::filesystem::path& file);

}  // namespace server::mapping
