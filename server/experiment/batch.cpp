// server/experiment/batch.cpp: workers that take the next run until there is none.
#include "server/experiment/batch.hpp"

#include <mutex>
#include <stdexcept>

#include <fmt/format.h>

#include "algo/driving.hpp"
#include "server/experiment/parallel.hpp"
#include "server/run/frame_pool.hpp"
#include "server/run/runner.hpp"

namespace server::reproduce {

RunFigures run_once(const RunSpec& spec, bool keep_track) {
  const std::unique_ptr<algo::Robot> robot = make_robot(spec);
  robot->set_pace({.paused = false, .speed = 0});
  algo::Pipeline pipeline(pipeline_config(spec), robot->spec());
  PathRecorder path(robot->spec().radius, robot->spec().period);
  StandingRecorder standing(
      {.v_max = spec.parameters[algo::kMaxSpeed], .omega_max = spec.parameters[algo::kMaxTurnRate]},
      robot->spec().period);
  const double safety_distance = spec.parameters[algo::kSafetyDistance];

  RunFigures figures;
  const std::shared_ptr<FramePool> pool = FramePool::make(2);  // the present tick and the next
  RunLinks links;
  links.pool = pool.get();
  links.observer = [&](const Frame& frame) {
    path.add(frame.telemetry, safety_distance);
    standing.add(frame.telemetry);
    if (!frame.telemetry.ground_truth) return;
    figures.end_W = frame.telemetry.ground_truth->pose.position();
    if (keep_track) figures.track_W.push_back(figures.end_W);
  };
  const RunPolicy policy{.until_outcome = true, .time_limit = time_limit(spec)};
  const RunResult result = run(*robot, pipeline, first_requests(spec), policy, links, {});
  if (result.outcome == algo::Outcome::Failed) throw std::runtime_error(result.reason);
  figures.outcome = result.outcome;
  figures.metrics = result.metrics;
  figures.path = path.figures();
  figures.standing = standing.figures();
  return figures;
}

std::vector<Row> run_rows(const std::vector<RowJob>& jobs,
                          unsigned threads,
                          const Progress& progress) {
  std::vector<Row> rows;
  std::vector<std::pair<std::size_t, std::size_t>> runs;  // row, seed within it
  for (std::size_t row = 0; row < jobs.size(); ++row) {
    rows.push_back({jobs[row].layout, jobs[row].reading, std::vector<RunFigures>(jobs[row].seeds)});
    for (std::size_t seed = 0; seed < jobs[row].seeds; ++seed) runs.emplace_back(row, seed);
  }

  std::mutex mutex;  // of progress and its count
  std::size_t done = 0;
  in_parallel(runs.size(), threads, [&](std::size_t i) {
    const auto [row, seed] = runs[i];
    try {
      RunSpec spec = jobs[row].spec;
      spec.seed += seed;
      rows[row].runs[seed] = run_once(spec, seed == 0);
    } catch (const std::exception& e) {
      throw std::runtime_error(
          fmt::format("{}, {}: {}", jobs[row].layout, jobs[row].reading, e.what()));
    }
    const std::lock_guard lock(mutex);
    if (progress) progress(++done, runs.size());
  });
  return rows;
}

}  // namespace server::reproduce
