// server/lab/mapping/map_study.hpp: a recorded log, its poses corrupted with odometry errors, and
// how much of the error scan matching corrects.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "algo/mapping/occupancy_map.hpp"
#include "server/experiment/pool.hpp"
#include "server/lab/mapping/path_error.hpp"
#include "server/lab/mapping/relations.hpp"
#include "server/lab/mapping/sharpness.hpp"
#include "sim/scenario.hpp"

namespace server::mapping {

/// All scans of a CARMEN log, and the robot's pose at each scan.
struct Recording {
  std::string name{};  // of the file, without folder and ending
  std::vector<algo::LaserScan> scans{};
  std::vector<algo::Pose2> path_W{};  // one pose per scan
  std::vector<double> stamps{};       // [s] as recorded, one per scan; 0 where the log has none
  std::string damage{};               // sim::Replay::damage()
};

/// Throws std::runtime_error with a sentence if the file does not exist, holds no scan, or has
/// poses between which no robot drove.
Recording read_recording(const std::filesystem::path& file);

struct MapOptions {
  sim::DriveConfig errors{};  // uses odometry_slip, odometry_scale, odometry_noise
  bool match = false;
  std::vector<Relation> relations{};  // of the log; judges the matched path
  std::uint64_t first_seed = 1;
  std::size_t seeds = 1;
  unsigned threads = 0;  // 0: one per core
  experiment::Progress progress{};
};

/// The run of one seed: the log's poses with odometry errors, and the path found from them.
struct MapRun {
  std::uint64_t seed = 0;
  std::vector<algo::Pose2> odometry_W{};
  std::vector<algo::Pose2> matched_W{};  // empty without matching
  PathError odometry{};
  PathError matched{};
  std::vector<std::size_t> matched_cells{};  // see wall_cells(); likewise log_cells
  RelationError relations{};                 // of the matched path
  double scan_time = 0;                      // [s] CPU per scan, for the whole path
  std::size_t map_bytes = 0;                 // of the matcher's submaps and graph, at the end
  std::size_t loops = 0;                     // closed
};

struct MapStudy {
  Recording log{};
  MapOptions options{};
  std::vector<MapRun> runs{};            // one per seed
  std::vector<std::size_t> log_cells{};  // along the log's own poses; only with matching
};

/// Throws std::invalid_argument if the errors are invalid.
MapStudy study_map(Recording log, const MapOptions& options);

/// The map of the scans, taking `path_W` as true.
algo::OccupancyMap map_along(const Recording& log, const std::vector<algo::Pose2>& path_W);

/// The path of the first seed: the matched one if there is one.
const std::vector<algo::Pose2>& first_path(const MapStudy& study);

/// Writes first_path(): one line a scan with the log's stamp, x, y [m] and heading [rad]. Throws
/// std::runtime_error.
void write_poses(const MapStudy& study, const std::filesystem::path& file);

nlohmann::json to_json(const MapStudy& study);
/// One study as itself, several as an array.
nlohmann::json to_json(const std::vector<MapStudy>& studies);
std::string to_text(const MapStudy& study);

/// Draws the map along `path_W`, and that path, as an SVG document.
std::string draw_map(const Recording& log,
                     const std::vector<algo::Pose2>& path_W,
                     const std::string& title);

/// Writes the tables of all `studies` into `file`, replacing those of an earlier call, and the
/// pictures into pictures/mapping/ beside it. Throws std::runtime_error.
void write_markdown(const std::vector<MapStudy>& studies, const std::filesystem::path& file);

}  // namespace server::mapping
