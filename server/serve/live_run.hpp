// server/serve/live_run.hpp: a session's run in progress: on the scheduler, or on its own thread
// for hardware and for a controller outside the program, which may take its time.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <vector>

#include "algo/metrics.hpp"
#include "server/record/record_sink.hpp"
#include "server/record/recorder.hpp"
#include "server/record/run_json.hpp"
#include "server/run/frame_pool.hpp"
#include "server/run/run_spec.hpp"
#include "server/run/runner.hpp"
#include "server/serve/operator_watch.hpp"
#include "server/serve/scheduler.hpp"

namespace server {

/// Services that all runs of a server share.
struct RunHouse {
  Recorder* recorder = nullptr;  // null: nothing is recorded
  Scheduler& scheduler;
  std::shared_ptr<FrameRoom> frames{};  // shared by fast runs, beyond each run's own frames
  bool tells_record_news = true;        // this session reports the recorder's news, which come once
  bool require_record = false;          // a tick that cannot be recorded ends the run
};

/// One Run with its rings and frames. Any thread may construct it. The io thread begins it. A
/// thread that may wait destroys it.
class LiveRun final : private Scheduler::Task {
 public:
  /// `news` is called on the thread that advances the run, when the rings have data.
  LiveRun(RunSpec spec,
          std::unique_ptr<algo::Robot> robot,
          std::shared_ptr<RunChannel> channel,
          const RunHouse& house,
          OperatorWatch& watch,
          std::function<void()> news);
  /// Ends the loop and waits for it: at most one robot period, or 0.1 s of another's controller.
  ~LiveRun() override;
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;

  /// Begins the run; applies `first` before the first tick. Call it once.
  void start(const std::vector<algo::Request>& first);
  /// Asks the loop to end, without waiting for it.
  void ask_to_end();
  /// Marks that the run ends because the program does, not on a request.
  void cut() { cut_.store(true, std::memory_order_relaxed); }
  void set_pace(const Pace& pace);
  /// `rings.requests` has data.
  void wake();

  Rings rings{};
  algo::Robot& robot() { return *robot_; }
  algo::Outcome outcome() const { return outcome_.load(std::memory_order_relaxed); }
  /// The first outcome of the run, with the metrics then: later goals do not change it.
  std::optional<FirstOutcome> verdict() const;
  /// Lateness of the ticks against their deadlines. Hardware gives it in its own report.
  algo::LatenessHistogram lateness() const { return pacer_.lateness(); }
  bool finished() const { return finished_.load(std::memory_order_acquire); }
  /// Valid only after finished() is true.
  const RunResult& result() const { return result_; }
  /// Off if the run is not recorded, or its record has no status yet.
  RecordStatus record_status() const { return channel_ ? channel_->status() : RecordStatus{}; }
  db::RunId id() const { return channel_ ? channel_->run() : 0; }

 private:
  Run::Next advance() override;
  RunLinks links();
  void conclude();
  void look_for_operator(const algo::Telemetry& t);

  RunSpec spec_;
  std::unique_ptr<algo::Robot> robot_;
  algo::Arming* arming_;  // set for hardware
  const bool own_thread_;
  std::stop_source stop_{};
  algo::Pipeline pipeline_;
  std::shared_ptr<RunChannel> channel_;
  std::unique_ptr<RecordSink> sink_{};
  Scheduler& scheduler_;
  OperatorWatch& watch_;
  std::shared_ptr<FramePool> pool_;
  Pacer pacer_{};
  Run run_;
  bool started_ = false;
  RunResult result_{};
  std::atomic<bool> cut_{false};
  mutable std::mutex mutex_{};
  std::optional<FirstOutcome> verdict_{};  // guarded by mutex_
  std::atomic<algo::Outcome> outcome_{algo::Outcome::Running};
  std::atomic<bool> finished_{false};
  std::jthread thread_{};  // last: it uses all of the above. Only with own_thread_
};

}  // namespace server
