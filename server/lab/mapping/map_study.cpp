// server/lab/mapping/map_study.cpp: recordings, paths with odometry errors, matched paths.
#include "server/lab/mapping/map_study.hpp"

#include <cmath>
#include <ctime>
#include <stdexcept>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "sim/drive_errors.hpp"
#include "sim/replay.hpp"

namespace server::mapping {
namespace {

constexpr double kMargin = 15;    // [m] of map around the path
constexpr double kLargest = 400;  // [m] edge of a map; a log that needs more has bad poses

double cpu_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

algo::Mapper mapper_for(const std::vector<algo::Pose2>& path_W, bool match) {
  Eigen::AlignedBox2d bounds(path_W.front().position());
  for (const algo::Pose2& pose_W : path_W) bounds.extend(pose_W.position());
  const double edge = bounds.sizes().maxCoeff() + 2 * kMargin;
  if (!(edge <= kLargest)) {
    throw std::runtime_error(fmt::format(
        "The path of the log is {:.0f} m wide; a map of more than {:.0f} m is not made.",
        edge - 2 * kMargin,
        kLargest - 2 * kMargin));
  }
  algo::MapperSettings settings;
  settings.match = match;
  const int side = static_cast<int>(std::ceil(edge / settings.cell));
  return {settings, side, bounds.center()};
}

void match_run(const Recording& log, MapRun& run) {
  algo::Mapper mapper = mapper_for(run.odometry_W, true);
  run.matched_W.reserve(log.scans.size());
  const double begin = cpu_seconds();
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    run.matched_W.push_back(mapper.add(log.scans[i], run.odometry_W[i]));
  }
  run.scan_time = (cpu_seconds() - begin) / static_cast<double>(log.scans.size());
  run.matched = path_error(log.path_W, run.matched_W);
  run.matched_cells = wall_cells(log.scans, run.matched_W, log.path_W);
}

nlohmann::json to_json(const PathError& error) {
  return {{"end_m", error.end},
          {"rms_m", error.rms},
          {"rms_10m_m", error.rms_10m},
          {"turn_10m_rad", error.turn_10m}};
}

}  // namespace

Recording read_recording(const std::filesystem::path& file) {
  sim::Replay replay(file);
  Recording log;
  log.name = file.stem().string();
  algo::Observation observation;
  replay.reset(observation);
  for (std::size_t i = 0; i < replay.size(); ++i) {
    if (i > 0) replay.step({}, observation);
    log.scans.push_back(observation.scans[0]);
    log.path_W.push_back(observation.odometry.pose);
  }
  return log;
}

MapStudy study_map(Recording log, const MapOptions& options) {
  if (const auto problem = sim::defect(options.errors)) throw std::invalid_argument(*problem);
  MapStudy study{std::move(log), options, std::vector<MapRun>(options.seeds)};
  if (options.match) {
    study.log_cells = wall_cells(study.log.scans, study.log.path_W, study.log.path_W);
  }
  const experiment::PoolOptions pool{.threads = options.threads, .progress = options.progress};
  for_each(options.seeds, pool, [&](std::size_t i, const std::stop_token& /*stop*/) {
    MapRun& run = study.runs[i];
    run.seed = options.first_seed + i;
    run.odometry_W = sim::reported_path(study.log.path_W, options.errors, run.seed);
    run.odometry = path_error(study.log.path_W, run.odometry_W);
    if (options.match) match_run(study.log, run);
  });
  return study;
}

algo::OccupancyMap map_along(const Recording& log, const std::vector<algo::Pose2>& path_W) {
  algo::Mapper mapper = mapper_for(path_W, false);
  for (std::size_t i = 0; i < log.scans.size(); ++i) mapper.add(log.scans[i], path_W[i]);
  return mapper.map();
}

nlohmann::json to_json(const MapStudy& study) {
  nlohmann::json out = {{"log", study.log.name},
                        {"scans", study.log.scans.size()},
                        {"length_m", path_length(study.log.path_W)},
                        {"odometry_scale", study.options.errors.odometry_scale},
                        {"yaw_slip", study.options.errors.odometry_slip},
                        {"odometry_noise", study.options.errors.odometry_noise},
                        {"runs", nlohmann::json::array()}};
  if (study.options.match) out["log_wall_cells"] = study.log_cells;
  for (const MapRun& run : study.runs) {
    nlohmann::json row = {{"seed", run.seed}, {"odometry", to_json(run.odometry)}};
    if (study.options.match) {
      row["matched"] = to_json(run.matched);
      row["wall_cells"] = run.matched_cells;
      row["scan_ms"] = 1e3 * run.scan_time;
    }
    out["runs"].push_back(std::move(row));
  }
  return out;
}

}  // namespace server::mapping
