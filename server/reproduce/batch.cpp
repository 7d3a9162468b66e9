// server/reproduce/batch.cpp: workers that take the next run until there is none.
#include "server/reproduce/batch.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <thread>

#include <fmt/format.h>

#include "server/frame_pool.hpp"
#include "server/runner.hpp"

namespace server::reproduce {

RunFigures run_once(const RunSpec& spec, bool keep_track) {
  const std::unique_ptr<algo::Robot> robot = make_robot(spec);
  robot->set_pace({.paused = false, .speed = 0});
  algo::Pipeline pipeline(pipeline_config(spec), robot->spec());
  PathRecorder path(robot->spec().radius, robot->spec().period);
  const double safety_distance = spec.parameters[algo::Parameter::SafetyDistance];

  RunFigures figures;
  const std::shared_ptr<FramePool> pool = FramePool::make(2);  // the present tick and the next
  RunLinks links;
  links.pool = pool.get();
  links.observer = [&](const Frame& frame) {
    path.add(frame.telemetry, safety_distance);
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

  std::atomic<std::size_t> next{0};
  std::atomic<bool> broken{false};
  std::mutex mutex;  // of the two below and of progress
  std::size_t done = 0;
  std::exception_ptr problem;
  const auto work = [&] {
    for (std::size_t i = next++; i < runs.size() && !broken; i = next++) {
      const auto [row, seed] = runs[i];
      try {
        RunSpec spec = jobs[row].spec;
        spec.seed += seed;
        rows[row].runs[seed] = run_once(spec, seed == 0);
      } catch (const std::exception& e) {
        const std::lock_guard lock(mutex);
        broken = true;
        problem = std::make_exception_ptr(std::runtime_error(
            fmt::format("{}, {}: {}", jobs[row].layout, jobs[row].reading, e.what())));
      }
      const std::lock_guard lock(mutex);
      if (progress) progress(++done, runs.size());
    }
  };
  {
    if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency());
    std::vector<std::jthread> workers;
    for (unsigned i = 0; i < threads; ++i) workers.emplace_back(work);
  }
  if (problem) std::rethrow_exception(problem);
  return rows;
}

}  // namespace server::reproduce
