// server/experiment/sweep/sweep_estimate.cpp: what an experiment costs, from some seconds of each
// controller.
#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>

#include "server/experiment/sweep/sweep_run.hpp"
#include "server/experiment/track.hpp"
#include "server/run/json_limits.hpp"
#include "server/run/scenario_json.hpp"

namespace server::sweep {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr double kMeasured = 5;       // [s] of the run clock
constexpr double kCsvPerLogLine = 1;  // a run has about as many bytes in runs.csv as in the log

/// The cost of one run of a controller.
struct Cost {
  double cpu_begin = 0;  // [s] of CPU before its first tick,
  double cpu_rate = 0;   // and per second of the run clock
  double bytes = 0;      // of its line
  bool whole = true;     // it drove all of its seconds
};

/// Requests a stop some time after start(), or when `outer` does.
class Deadline {
 public:
  explicit Deadline(const std::stop_token& outer)
      : outer_(outer, [this] { over_.request_stop(); }) {}

  void start(Seconds time) {
    timer_ = std::jthread([this, time](const std::stop_token& unneeded) {
      std::mutex mutex;
      std::unique_lock lock(mutex);
      std::condition_variable_any().wait_for(lock, unneeded, time, [] { return false; });
      over_.request_stop();
    });
  }
  std::stop_token token() const { return over_.get_token(); }

 private:
  std::stop_source over_{};
  std::stop_callback<std::function<void()>> outer_;
  std::jthread timer_{};
};

Cost measured(experiment::Trial trial, Seconds most, const std::stop_token& stop) {
  double& limit = trial.spec.scenario.time_limit;
  limit = std::min(time_limit(trial.spec), kMeasured);
  Deadline deadline(stop);
  const double begin = experiment::cpu_time();
  double first_tick = begin;
  // The world is there when the run would open its record.
  experiment::Row row =
      run_trial(trial, {.stop = deadline.token(), .record = [&](const algo::RobotSpec&) {
                          first_tick = experiment::cpu_time();
                          deadline.start(most);
                          return std::shared_ptr<RunChannel>();
                        }});
  row.track_W = experiment::coarse(row.track_W);
  const double time = row["time_s"];
  const double least = trial.spec.scenario.period;
  return {first_tick - begin,
          (experiment::cpu_time() - first_tick) / (time > least ? time : least),
          static_cast<double>(dump_json(row_json(0, row)).size() + 1),
          row.outcome != algo::Outcome::Stopped};
}

/// Measures each controller once, while there is time.
class Meter {
 public:
  Meter(const Plan& plan, const EstimateOptions& options) : plan_(plan), options_(options) {
    for (const ControllerChoice& each : plan.document().controllers) left_.insert(each.name);
  }

  Cost of(std::size_t run) {
    const std::size_t controller = plan_.arms()[plan_.place(run).arm].controller;
    const std::string& name = plan_.document().controllers[controller].name;
    if (const auto known = costs_.find(name); known != costs_.end()) return known->second;
    const Seconds rest = end_ - Clock::now();
    const bool late = !costs_.empty() && (rest <= Seconds(0) || options_.stop.stop_requested());
    const double shares = static_cast<double>(left_.size());
    const Cost cost = late ? mean() : measured(plan_.trial(run), rest / shares, options_.stop);
    left_.erase(name);
    extrapolated_ |= !cost.whole;
    return costs_.emplace(name, cost).first->second;
  }
  bool extrapolated() const { return extrapolated_; }

 private:
  Cost mean() const {
    Cost sum{.whole = false};
    const auto share = 1 / static_cast<double>(costs_.size());
    for (const auto& [name, cost] : costs_) {
      sum.cpu_begin += share * cost.cpu_begin;
      sum.cpu_rate += share * cost.cpu_rate;
      sum.bytes += share * cost.bytes;
    }
    return sum;
  }

  const Plan& plan_;
  const EstimateOptions& options_;
  const Clock::time_point end_ =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(Seconds(options_.most_time));
  std::set<std::string> left_{};         // controllers not measured yet
  std::map<std::string, Cost> costs_{};  // by controller
  bool extrapolated_ = false;
};

}  // namespace

Estimate estimate(const Plan& plan, const EstimateOptions& options) {
  Estimate sum;
  Meter meter(plan, options);
  for (std::size_t i = 0; i < plan.size() && !options.stop.stop_requested();) {
    const RunPlace at = plan.place(i);
    const auto repeats = static_cast<double>(plan.repeats(at.scenario, at.arm));
    const Cost cost = meter.of(i);
    sum.cpu_time +=
        repeats * (cost.cpu_begin + cost.cpu_rate * plan.time_limit(at.scenario, at.arm));
    sum.bytes += repeats * cost.bytes * (1 + kCsvPerLogLine);
    i += plan.repeats(at.scenario, at.arm);
  }
  for (const sim::Scenario& scenario : plan.document().scenarios) {
    sum.bytes += static_cast<double>(to_json(scenario).dump(1).size());
  }
  sum.extrapolated = meter.extrapolated();
  return sum;
}

}  // namespace server::sweep
