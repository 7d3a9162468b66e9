// server/experiment/trial.hpp: one run, measured by the named judges, gives one row.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "algo/metrics.hpp"
#include "server/experiment/judge.hpp"
#include "server/experiment/pool.hpp"
#include "server/record/headless.hpp"
#include "server/run/run_spec.hpp"

namespace server::experiment {

struct JudgeChoice {
  std::string name{};
  Settings settings{};
};

/// Plain data. The same trial gives the same row, however many trials run in parallel.
struct Trial {
  std::string name{};  // for people: "case1, modified, seed 3"
  RunSpec spec{};
  std::vector<JudgeChoice> judges{};
  /// The judge that ends the run; empty: the loop's own outcome or the scenario's time limit ends
  /// it.
  std::string until{};
  bool keep_track = false;  // in the row
  bool time_ticks = false;  // in the row; otherwise the clock is not read
};

/// The result of one trial.
struct Row {
  using Figure = std::pair<std::string_view, double>;  // a judge's column and its value

  algo::Outcome outcome = algo::Outcome::Running;
  std::string reason{};           // a sentence if the outcome needs a reason
  bool broken = false;            // Failed, but not by a judge's ending
  std::vector<Figure> figures{};  // in the order of the judges; NaN: not known
  std::vector<algo::Vec2> track_W{};
  std::vector<float> tick_us{};  // [us] CPU time of each control tick

  /// The figure of that column. Throws std::out_of_range if no judge wrote it.
  double operator[](std::string_view column) const;
};

/// How to run a trial.
struct TrialOptions {
  std::stop_token stop{};
  double pace = 0;  // times real time; 0: as fast as possible
  /// Opens the record of the run; empty: no record.
  std::function<std::shared_ptr<RunChannel>(const algo::RobotSpec& robot)> record{};
  std::function<bool()> cancelled{};  // as in HeadlessOptions
};

/// [s] CPU time of this thread: other load on the machine does not count.
double cpu_time();

/// Throws std::exception with a sentence if the robot or a judge cannot be made, and any exception
/// of `record`. If the run itself breaks, the row says Failed, with the reason.
Row run_trial(const Trial& trial, const TrialOptions& options = {});

/// The rows of the shard's trials among `count`, in their order for any number of threads; trials
/// skipped after `stop` are Stopped. Workers make each trial when its turn comes, so a long list
/// need not be in memory. A broken run throws std::runtime_error with the trial's name.
std::vector<Row> run_trials(std::size_t count,
                            const std::function<Trial(std::size_t i)>& trial,
                            const PoolOptions& options);

}  // namespace server::experiment
