// server/serve/live_run.hpp: a run of a session at work on its own thread.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

#include "algo/metrics.hpp"
#include "server/record/recorder.hpp"
#include "server/run/frame_pool.hpp"
#include "server/run/run_spec.hpp"
#include "server/run/runner.hpp"
#include "server/serve/operator_watch.hpp"

namespace server {

/// One call of run() with its thread, rings and frames. Made on any thread, begun by the io thread,
/// and ended by whoever may wait for it.
class LiveRun {
 public:
  LiveRun(RunSpec spec,
          std::unique_ptr<algo::Robot> robot,
          std::shared_ptr<RunChannel> channel,
          OperatorWatch& watch,
          bool require_record);
  ~LiveRun();  // asks the loop to end and waits for it: at most one period of the robot

  /// Begins, with these requests before the first tick. Once only.
  void start(std::vector<algo::Request> first);
  /// Asks the loop to end, without waiting for it.
  void ask_to_end();
  /// The run ends because the program does, not because somebody wants it to.
  void cut() { cut_.store(true, std::memory_order_relaxed); }

  Rings rings{};
  algo::Robot& robot() { return *robot_; }
  algo::Outcome outcome() const { return outcome_.load(std::memory_order_relaxed); }
  /// The figures when the outcome last changed.
  algo::Metrics metrics() const;
  bool finished() const { return finished_.load(std::memory_order_acquire); }
  /// Only once finished() is true.
  const RunResult& result() const { return result_; }
  db::RunId id() const { return channel_ ? channel_->run() : 0; }

 private:
  void control(const std::stop_token& stop);
  void look_for_operator(const algo::Telemetry& t);

  RunSpec spec_;
  std::unique_ptr<algo::Robot> robot_;
  algo::Pipeline pipeline_;
  std::vector<algo::Request> first_;
  std::shared_ptr<RunChannel> channel_;
  OperatorWatch& watch_;
  std::shared_ptr<FramePool> pool_;
  RunPolicy policy_;
  RunResult result_{};
  std::atomic<bool> cut_{false};
  mutable std::mutex mutex_{};
  algo::Metrics metrics_{};  // guarded by mutex_, which is taken only when the outcome changes
  std::atomic<algo::Outcome> outcome_{algo::Outcome::Running};
  std::atomic<bool> finished_{false};
  std::jthread thread_{};  // last: it uses all of the above
};

}  // namespace server
