// server/lab/mapping/map_study.cpp: recordings, paths with odometry errors, matched paths.
#include "server/lab/mapping/map_study.hpp"

#include <cmath>
#include <ctime>
#include <stdexcept>

#include <fmt/format.h>

#include "algo/mapping/graph_mapper.hpp"
#include "server/run/text_file.hpp"
#include "sim/drive_errors.hpp"
#include "sim/replay.hpp"

namespace server::mapping {
namespace {

constexpr double kFarthestStep = 100;  // [m] between two scans of one drive

double cpu_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void match_run(const MapStudy& study, MapRun& run) {
  const Recording& log = study.log;
  algo::GraphMapper mapper({});
  const double begin = cpu_seconds();
  for (std::size_t i = 0; i < log.scans.size(); ++i) mapper.add(log.scans[i], run.odometry_W[i]);
  run.matched_W = mapper.finish(log.scans);
  run.scan_time = (cpu_seconds() - begin) / static_cast<double>(log.scans.size());
  run.map_bytes = mapper.bytes();
  run.loops = mapper.loops().closed().size();
  run.matched = path_error(log.path_W, run.matched_W);
  run.relations = relation_error(study.options.relations, run.matched_W);
  run.matched_cells = wall_cells(log.scans, run.matched_W, log.path_W);
}

void check_poses(const Recording& log) {
  for (std::size_t i = 0; i < log.path_W.size(); ++i) {
    const algo::Pose2& pose_W = log.path_W[i];
    const algo::Pose2& before_W = log.path_W[i > 0 ? i - 1 : 0];
    const double step = (pose_W.position() - before_W.position()).norm();
    if (finite(pose_W) && step <= kFarthestStep) continue;
    throw std::runtime_error(
        fmt::format("The poses of the log {} are of no use: scan {} lies {:.3g} m from the scan "
                    "before it.",
                    log.name,
                    i + 1,
                    step));
  }
}

nlohmann::json to_json(const PathError& error) {
  return {{"end_m", error.end},
          {"rms_m", error.rms},
          {"rms_10m_m", error.rms_10m},
          {"turn_10m_rad", error.turn_10m}};
}

void put_relations(const RelationError& error, nlohmann::json& out) {
  out["relations"] = error.count;
  out["translation_mean_m"] = error.translation_mean;
  out["translation_sd_m"] = error.translation_sd;
  out["rotation_mean_rad"] = error.rotation_mean;
  out["rotation_sd_rad"] = error.rotation_sd;
}

}  // namespace

Recording read_recording(const std::filesystem::path& file) {
  sim::Replay replay(file);
  Recording log;
  log.name = file.stem().string();
  log.damage = replay.damage();
  algo::Observation observation;
  replay.reset(observation);
  for (std::size_t i = 0; i < replay.size(); ++i) {
    if (i > 0) replay.step({}, observation);
    log.scans.push_back(observation.scans[0]);
    log.path_W.push_back(observation.odometry.pose);
    log.stamps.push_back(replay.recorded_stamp());
  }
  check_poses(log);
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
    if (options.match) match_run(study, run);
  });
  return study;
}

algo::OccupancyMap map_along(const Recording& log, const std::vector<algo::Pose2>& path_W) {
  const algo::MapperSettings settings;
  algo::OccupancyMap map(settings.cell);
  algo::Pose2 entered_W{};
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    if (i > 0 && !apart(entered_W, path_W[i], settings)) continue;
    map.insert(log.scans[i], compose(path_W[i], log.scans[i].mount_R), settings.reach);
    entered_W = path_W[i];
  }
  return map;
}

const std::vector<algo::Pose2>& first_path(const MapStudy& study) {
  const MapRun& run = study.runs.front();
  return study.options.match ? run.matched_W : run.odometry_W;
}

void write_poses(const MapStudy& study, const std::filesystem::path& file) {
  std::string text;
  const std::vector<algo::Pose2>& path_W = first_path(study);
  for (std::size_t i = 0; i < path_W.size(); ++i) {
    text += fmt::format("{:.6f} {:.6f} {:.6f} {:.6f}\n",
                        study.log.stamps[i],
                        path_W[i].x,
                        path_W[i].y,
                        path_W[i].heading);
  }
  write_text(file, text);
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
  if (!study.options.relations.empty()) put_relations(study.runs.front().relations, out);
  for (const MapRun& run : study.runs) {
    nlohmann::json row = {{"seed", run.seed}, {"odometry", to_json(run.odometry)}};
    if (study.options.match) {
      row["matched"] = to_json(run.matched);
      row["wall_cells"] = run.matched_cells;
      row["scan_ms"] = 1e3 * run.scan_time;
      row["map_bytes"] = run.map_bytes;
      row["loops"] = run.loops;
    }
    out["runs"].push_back(std::move(row));
  }
  return out;
}

nlohmann::json to_json(const std::vector<MapStudy>& studies) {
  if (studies.size() == 1) return to_json(studies.front());
  nlohmann::json out = nlohmann::json::array();
  for (const MapStudy& study : studies) out.push_back(to_json(study));
  return out;
}

}  // namespace server::mapping
