// server/run/runner.hpp: the loop: one call is one run of one robot with one controller.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>

#include <boost/lockfree/spsc_queue.hpp>

#include "algo/metrics.hpp"
#include "algo/pipeline/pipeline.hpp"
#include "algo/robot.hpp"
#include "server/run/frame_pool.hpp"

namespace server {

/// A request on its way to the control thread, and the answer on its way back.
struct Submission {
  std::uint64_t ticket = 0;
  algo::Request request{};
};
/// Ticket of a reply that nobody asked for: a real robot was disarmed or stopped, and its goals are
/// cleared.
constexpr std::uint64_t kGoalsCleared = 0;
struct Reply {
  std::uint64_t ticket = 0;
  std::optional<std::string> refusal{};  // none: accepted
};

/// What connects a live run to the io thread: one producer and one consumer each. Run-time
/// capacities: Boost 1.74's compile-time form leaks what is still queued when it goes.
struct Rings {
  boost::lockfree::spsc_queue<Submission> requests{256};
  boost::lockfree::spsc_queue<Reply> replies{1024};
  boost::lockfree::spsc_queue<FrameRef> stream{64};
  std::atomic<bool> stop_now{false};  // a Stop after all in the ring, which was full
};

/// Where a run's frames are kept. Called on the control thread: must not block.
class FrameSink {
 public:
  virtual ~FrameSink() = default;
  /// False when full just now.
  virtual bool push(const FrameRef& frame) = 0;
  /// Frames are left out on purpose until the next push.
  virtual void pause() {}
  /// What is pushed is not kept just now (disk full): a sentence.
  virtual std::optional<std::string> failure() const { return std::nullopt; }
};

struct RunPolicy {
  bool until_outcome = false;  // headless: ends when reached, stuck, collided or out of time
  double time_limit = 0;       // [s] run clock; 0 = none
  /// What a tick waits at most for a record that cannot keep up; unset: as long as it takes. The
  /// ticks after it are lost until the record takes one again. A real robot never waits.
  std::optional<std::chrono::milliseconds> record_patience{};
  double pause_record_after = 0;  // [s] run clock in which nothing happened; 0: never
  bool require_record = false;    // a tick that is not kept ends the run
};

struct RunResult {
  algo::Outcome outcome = algo::Outcome::Running;
  std::string reason{};  // one sentence where the outcome does not speak for itself
  algo::Metrics metrics{};
  std::uint64_t lost_ticks = 0;      // not recorded because the record could not keep up
  std::uint64_t missed_periods = 0;  // gone by unused because a tick took too long
};

struct RunLinks {
  FramePool* pool = nullptr;                     // never null
  Rings* rings = nullptr;                        // null: nobody watches or asks
  FrameSink* record = nullptr;                   // null: not recorded
  std::function<void(const Frame&)> observer{};  // control thread, after each tick; for tests, CLI
  /// Control thread. A real robot's arming (SerialRobot::arming); empty for a simulated one.
  std::function<std::uint32_t()> arming{};
  /// Control thread, each time the outcome changes; with the figures so far.
  std::function<void(algo::Outcome, const algo::Metrics&)> on_outcome{};
};

/// Drives `robot` with `pipeline` until `stop` is requested, the robot ends, or the policy says so.
/// The robot is stopped on every way out. `first` requests are applied before the first tick.
RunResult run(algo::Robot& robot,
              algo::Pipeline& pipeline,
              const std::vector<algo::Request>& first,
              const RunPolicy& policy,
              const RunLinks& links,
              const std::stop_token& stop);

}  // namespace server
