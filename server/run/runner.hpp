// server/run/runner.hpp: the control loop of one robot: sense, decide, act and publish once per
// period.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <boost/lockfree/spsc_queue.hpp>

#include "algo/metrics.hpp"
#include "algo/pipeline/pipeline.hpp"
#include "algo/robot.hpp"
#include "server/run/frame_pool.hpp"
#include "server/run/fresh_orders.hpp"
#include "server/run/pacer.hpp"

namespace server {

/// A request for the control thread, and its answer.
struct Submission {
  std::uint64_t ticket = 0;
  algo::Request request{};
};
/// Ticket of a reply without a request: a real robot was disarmed or stopped, which cleared its
/// goals.
constexpr std::uint64_t kGoalsCleared = 0;
struct Reply {
  std::uint64_t ticket = 0;
  std::optional<std::string> refusal{};  // none: accepted
};

/// Queues between a live run and the io thread, each with one producer and one consumer. Capacities
/// are set at run time: Boost 1.74's compile-time form leaks elements still queued at destruction.
struct Rings {
  boost::lockfree::spsc_queue<Submission> requests{256};
  boost::lockfree::spsc_queue<Reply> replies{1024};
  boost::lockfree::spsc_queue<FrameRef> stream{64};
  std::atomic<bool> stop_now{false};  // a Stop that follows all in the full ring
  std::function<void()> news{};       // control thread: replies or stream have data; may be empty
};

/// Keeps a run's frames. Called on the control thread: must not block.
class FrameSink {
 public:
  virtual ~FrameSink() = default;
  /// False when full now.
  virtual bool push(const FrameRef& frame) = 0;
  /// Frames are omitted on purpose until the next push.
  virtual void pause() {}
  /// Why pushed frames are not kept now (disk full), as a sentence.
  virtual std::optional<std::string> failure() const { return std::nullopt; }
};

struct RunPolicy {
  bool until_outcome = false;  // headless: ends when reached, stuck, collided, overturned, fallen
                               // or out of time
  double time_limit = 0;       // [s] run clock; 0 = none
  /// Longest wait of a tick for a record that cannot keep up; unset: no limit. After it, ticks are
  /// lost until the record accepts one again. A real robot never waits.
  std::optional<std::chrono::milliseconds> record_patience{};
  double pause_record_after = 0;  // [s] run clock without an event; 0: never
  bool require_record = false;    // a tick that cannot be kept ends the run
};

struct RunResult {
  algo::Outcome outcome = algo::Outcome::Running;
  std::string reason{};  // a sentence if the outcome needs a reason
  algo::Metrics metrics{};
  std::uint64_t lost_ticks = 0;      // not recorded: the record could not keep up
  std::uint64_t missed_periods = 0;  // skipped because a tick took too long
};

/// Called on the control thread after each tick, with the same immutable frame for all listeners.
using Listener = std::function<void(const Frame&)>;

struct RunLinks {
  FramePool* pool = nullptr;          // never null
  Rings* rings = nullptr;             // null: no viewer and no requests
  FrameSink* record = nullptr;        // null: not recorded
  std::vector<Listener> listeners{};  // judges, tests, the command line
  Pacer* pacer = nullptr;             // null: as fast as possible; a real robot keeps its own time
  /// Called on the control thread at each change of outcome, with its reason and the metrics so
  /// far.
  std::function<void(algo::Outcome, const char* reason, const algo::Metrics&)> on_outcome{};
};

/// Measures how long nothing has happened: no request came, and the robot neither drives nor moves,
/// and its hold reason is unchanged.
class Stillness {
 public:
  /// True if nothing has happened for longer than `span` [s] at `t`; never if `span` is 0.
  bool lasts(const algo::Telemetry& t, double span);

 private:
  double since_ = 0;  // [s] run clock of the last event
  algo::Mission mission_ = algo::Mission::Idle;
  algo::Hold hold_{};
};

/// One run in progress. It has no thread and waits only for a real robot's deadline. Its owner
/// calls advance() at the times that advance() asked for, from one thread at a time.
class Run {
 public:
  using Clock = Pacer::Clock;
  /// When to call advance() again.
  struct Next {
    enum class When : std::uint8_t {
      AtOnce,  // time runs as fast as possible
      At,
      Asked,  // paused: at `time`, or sooner when a request comes
      Over,
    };
    When when = When::AtOnce;
    Clock::time_point time{};  // unused with AtOnce and Over
  };

  /// `robot`, `pipeline` and all that `links` points to must outlive the run.
  Run(algo::Robot& robot,
      algo::Pipeline& pipeline,
      const RunPolicy& policy,
      RunLinks links,
      std::stop_token stop);

  /// Applies the requests `first` before the first tick. Call it once, before all else.
  void begin(const std::vector<algo::Request>& first);
  /// Advances at most one period. If called too early it serves requests and says when to call
  /// again.
  Next advance();
  /// Stops the robot. Call it once, after advance() returned Over or instead of advance().
  RunResult finish();

 private:
  enum class Phase : std::uint8_t { Reset, Keep, Step, Over };

  Next advance_phase();
  Next next_step();
  std::optional<Next> step();
  void tick();
  void serve_requests();
  void notice_arming();
  void void_orders();
  std::optional<std::string> refusal_of(const algo::Request& request);
  std::optional<std::string> carry_out(const algo::Request& request);
  void accept(const algo::Request& request);
  bool keep();
  bool try_to_keep();
  void judge(const algo::Telemetry& t);
  void set_outcome(algo::Outcome outcome, const char* reason = "");
  void show();
  void news() const;
  bool over() const;
  void give_up(algo::Outcome outcome, const char* what, const algo::Telemetry& t);
  bool wrecked() const;

  algo::Robot& robot_;
  algo::Arming* arming_;    // set for a real robot, which keeps its own time
  algo::Editing* editing_;  // null: obstacles cannot be edited
  algo::Pipeline& pipeline_;
  RunPolicy policy_;
  RunLinks links_;
  std::stop_token stop_;
  Phase phase_ = Phase::Reset;
  FrameRef frame_{};                         // of the newest tick
  bool shown_ = true;                        // the newest frame is in the ring
  algo::Recycled<algo::Request> pending_{};  // accepted; the next tick records them
  FreshOrders orders_{};
  double now_ = 0;  // [s] run clock, of the newest observation
  algo::MetricsRecorder metrics_{};
  RunResult result_{};
  Stillness stillness_{};
  std::optional<Clock::time_point> waits_since_{};  // newest tick waits for the record
  bool impatient_ = false;  // a tick waited too long for the record, which has taken none since
  bool broken_ = false;
};

/// Drives `robot` with `pipeline` until `stop` is requested, the robot ends the run, or the policy
/// does. Stops the robot on every way out. Applies the requests `first` before the first tick.
RunResult run(algo::Robot& robot,
              algo::Pipeline& pipeline,
              const std::vector<algo::Request>& first,
              const RunPolicy& policy,
              const RunLinks& links,
              const std::stop_token& stop);

}  // namespace server
