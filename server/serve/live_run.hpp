// server/serve/live_run.hpp: a run of a session at work: on the scheduler, or on a thread of its
// own when it is hardware.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

#include "algo/metrics.hpp"
#include "server/record/record_sink.hpp"
#include "server/record/recorder.hpp"
#include "server/run/frame_pool.hpp"
#include "server/run/run_spec.hpp"
#include "server/run/runner.hpp"
#include "server/serve/operator_watch.hpp"
#include "server/serve/scheduler.hpp"

namespace server {

/// What the runs of a server share.
struct RunHouse {
  Recorder* recorder = nullptr;  // null: nothing is kept
  Scheduler& scheduler;
  std::shared_ptr<FrameRoom> frames{};  // for runs that are fast, beyond what each has
  bool tells_record_news = true;        // of the recorder, which says each piece once
  bool require_record = false;          // a tick that is not recorded ends the run
};

/// One Run with its rings and frames. Made on any thread, begun by the io thread, and ended by
/// a thread that may wait for it.
class LiveRun final : private Scheduler::Task {
 public:
  /// `news` is called on the thread that advances the run, when its rings have something.
  LiveRun(RunSpec spec,
          std::unique_ptr<algo::Robot> robot,
          std::shared_ptr<RunChannel> channel,
          const RunHouse& house,
          OperatorWatch& watch,
          std::function<void()> news);
  ~LiveRun() override;  // asks the loop to end and waits for it: at most one period of the robot
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;

  /// Begins, with these requests before the first tick. Once only.
  void start(const std::vector<algo::Request>& first);
  /// Asks the loop to end, without waiting for it.
  void ask_to_end();
  /// The run ends because the program does, not because somebody wants it to.
  void cut() { cut_.store(true, std::memory_order_relaxed); }
  void set_pace(const Pace& pace);
  /// Something waits in `rings.requests`.
  void wake();

  Rings rings{};
  algo::Robot& robot() { return *robot_; }
  algo::Outcome outcome() const { return outcome_.load(std::memory_order_relaxed); }
  /// The figures when the outcome last changed.
  algo::Metrics metrics() const;
  /// How late its ticks were for their deadlines. Of hardware its own report tells.
  algo::LatenessHistogram lateness() const { return pacer_.lateness(); }
  bool finished() const { return finished_.load(std::memory_order_acquire); }
  /// Only once finished() is true.
  const RunResult& result() const { return result_; }
  /// Off when it is not recorded, or was not a moment ago.
  RecordStatus record_status() const { return channel_ ? channel_->status() : RecordStatus{}; }
  db::RunId id() const { return channel_ ? channel_->run() : 0; }

 private:
  Run::Next advance() override;
  RunLinks links();
  void conclude();
  void look_for_operator(const algo::Telemetry& t);

  RunSpec spec_;
  std::unique_ptr<algo::Robot> robot_;
  algo::Arming* arming_;  // of hardware
  algo::Pipeline pipeline_;
  std::shared_ptr<RunChannel> channel_;
  std::unique_ptr<RecordSink> sink_{};
  Scheduler& scheduler_;
  OperatorWatch& watch_;
  std::shared_ptr<FramePool> pool_;
  Pacer pacer_{};
  std::stop_source stop_{};
  Run run_;
  bool started_ = false;
  RunResult result_{};
  std::atomic<bool> cut_{false};
  mutable std::mutex mutex_{};
  algo::Metrics metrics_{};  // guarded by mutex_, which is taken only when the outcome changes
  std::atomic<algo::Outcome> outcome_{algo::Outcome::Running};
  std::atomic<bool> finished_{false};
  std::jthread thread_{};  // last: it uses all of the above. Of hardware only
};

}  // namespace server
