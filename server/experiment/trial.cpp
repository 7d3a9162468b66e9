// server/experiment/trial.cpp: runs one headless run with its judges.
#include "server/experiment/trial.hpp"

#include <algorithm>
#include <ctime>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "server/run/forwarding_robot.hpp"

namespace server::experiment {
namespace {

/// Stands before a robot and times each control tick: from the observation to the call of
/// ground_truth(), which the loop makes right after the tick.
class TimedRobot final : public ForwardingRobot {
 public:
  TimedRobot(std::unique_ptr<algo::Robot> robot, std::vector<float>& tick_us)
      : ForwardingRobot(std::move(robot)), tick_us_(tick_us) {}

  void reset(algo::Observation& observation) override {
    ForwardingRobot::reset(observation);
    begin_ = cpu_time();
  }
  bool step(const algo::Command& command, algo::Observation& observation) override {
    const bool stepped = ForwardingRobot::step(command, observation);
    begin_ = cpu_time();
    return stepped;
  }
  std::optional<algo::GroundTruth> ground_truth() const override {
    tick_us_.push_back(static_cast<float>((cpu_time() - begin_) * 1e6));
    return ForwardingRobot::ground_truth();
  }

 private:
  std::vector<float>& tick_us_;
  double begin_ = 0;  // [s]
};

/// The judges of one trial, each with its columns.
class Bench {
 public:
  Bench(const Trial& trial, const algo::RobotSpec& robot) {
    for (const JudgeChoice& choice : trial.judges) {
      const JudgeInfo& info = find_judge(choice.name);
      for (const auto& [name, value] : choice.settings) {
        if (std::ranges::find(info.settings, name) == info.settings.end()) {
          throw std::invalid_argument(
              fmt::format("the judge '{}' has no setting '{}'", info.name, name));
        }
      }
      seats_.push_back({&info, info.make({trial.spec, robot, choice.settings})});
      if (choice.name == trial.until && info.ends) until_ = seats_.back().judge.get();
    }
    if (!trial.until.empty() && until_ == nullptr) {
      throw std::invalid_argument(
          fmt::format("no judge '{}' of the trial has an ending of its own", trial.until));
    }
  }

  std::optional<Ending> see(const algo::Telemetry& t) {
    for (const Seat& seat : seats_) seat.judge->see(t);
    return until_ != nullptr ? until_->ending() : std::nullopt;
  }

  std::vector<Row::Figure> figures() const {
    std::vector<Row::Figure> all;
    for (const Seat& seat : seats_) {
      std::vector<double> values(seat.info->columns.size());
      seat.judge->write(values);
      for (std::size_t i = 0; i < values.size(); ++i) {
        all.emplace_back(seat.info->columns[i].name, values[i]);
      }
    }
    return all;
  }

 private:
  struct Seat {
    const JudgeInfo* info = nullptr;
    std::unique_ptr<Judge> judge{};
  };
  std::vector<Seat> seats_{};
  const Judge* until_ = nullptr;
};

}  // namespace

double Row::operator[](std::string_view column) const {
  const auto found = std::ranges::find(figures, column, &Figure::first);
  if (found == figures.end()) {
    throw std::out_of_range(fmt::format("no judge wrote '{}'", column));
  }
  return found->second;
}

double cpu_time() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

Row run_trial(const Trial& trial, const TrialOptions& options) {
  Row row;
  std::unique_ptr<algo::Robot> robot = make_robot(trial.spec);
  Bench bench(trial, robot->spec());
  HeadlessOptions headless{
      .pace = options.pace, .cancelled = options.cancelled, .until_watch = !trial.until.empty()};
  if (options.record) headless.record = options.record(robot->spec());
  if (trial.time_ticks) robot = std::make_unique<TimedRobot>(std::move(robot), row.tick_us);
  bool judged = false;
  headless.watch = [&](const algo::Telemetry& t) {
    if (trial.keep_track && t.ground_truth) {
      row.track_W.push_back(t.ground_truth->pose.position());
    }
    std::optional<Ending> ending = bench.see(t);
    judged = ending.has_value();
    return ending;
  };
  HeadlessResult result = run_headless(trial.spec, *robot, headless, options.stop);
  row.outcome = result.run.outcome;
  row.reason = std::move(result.run.reason);
  row.broken = row.outcome == algo::Outcome::Failed && !judged;
  row.figures = bench.figures();
  return row;
}

std::vector<Row> run_trials(std::size_t count,
                            const std::function<Trial(std::size_t)>& trial,
                            const PoolOptions& options) {
  std::vector<Row> rows(options.shard.share(count), Row{.outcome = algo::Outcome::Stopped});
  for_each(count, options, [&](std::size_t i, const std::stop_token& stop) {
    const Trial each = trial(i);
    Row row;
    try {
      row = run_trial(each, {.stop = stop});
    } catch (const std::exception& e) {
      throw std::runtime_error(fmt::format("{}: {}", each.name, e.what()));
    }
    if (row.broken) throw std::runtime_error(fmt::format("{}: {}", each.name, row.reason));
    rows[i / options.shard.count] = std::move(row);
  });
  return rows;
}

}  // namespace server::experiment
