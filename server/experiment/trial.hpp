// server/experiment/trial.hpp: a run description with the names of judges gives a row.
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

/// Plain data: the same trial gives the same row, however many run beside it.
struct Trial {
  std::string name{};  // for people: "case1, modified, seed 3"
  RunSpec spec{};
  std::vector<JudgeChoice> judges{};
  /// The judge among them whose ending is the run's; empty: the loop's own outcome and the
  /// scenario's time limit end it.
  std::string until{};
  bool keep_track = false;  // in the row
  bool time_ticks = false;  // in the row; for nobody else the clock is read
};

/// What came of one trial.
struct Row {
  using Figure = std::pair<std::string_view, double>;  // a judge's column and its value

  algo::Outcome outcome = algo::Outcome::Running;
  std::string reason{};           // one sentence where the outcome does not speak for itself
  bool broken = false;            // Failed, and not because a judge calls it so
  std::vector<Figure> figures{};  // of the judges, in their order; NaN: not known
  std::vector<algo::Vec2> track_W{};
  std::vector<float> tick_us{};  // [us] CPU time of each control tick

  /// The figure of that column. Throws std::out_of_range when no judge wrote it.
  double operator[](std::string_view column) const;
};

/// How a trial is run, beside what it is.
struct TrialOptions {
  std::stop_token stop{};
  double pace = 0;  // times real time; 0: as fast as it goes
  /// Opens the record of the run, when it is to be kept.
  std::function<std::shared_ptr<RunChannel>(const algo::RobotSpec& robot)> record{};
  std::function<bool()> cancelled{};  // as in HeadlessOptions
};

/// Throws std::exception with a sentence when the robot or a judge cannot be made, and whatever
/// `record` throws. What breaks the run itself is in the row: Failed, with the reason.
Row run_trial(const Trial& trial, const TrialOptions& options = {});

/// The rows of the shard's trials among `count`, in their order, whatever the number of threads;
/// trials that `stop` left out are Stopped. Trials are made on the workers, one after the other, so
/// that a long list need not be in memory. A run that fails, unless its judge says so, throws
/// std::runtime_error with the trial's name.
std::vector<Row> run_trials(std::size_t count,
                            const std::function<Trial(std::size_t i)>& trial,
                            const PoolOptions& options);

}  // namespace server::experiment
