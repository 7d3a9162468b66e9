// server/run/runner.hpp: the loop: sense, decide, act, publish, once per period of one robot.
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
  std::function<void()> news{};  // control thread: replies or stream have something; may be empty
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

/// Called on the control thread after each tick, with the same immutable frame for all.
using Listener = std::function<void(const Frame&)>;

struct RunLinks {
  FramePool* pool = nullptr;          // never null
  Rings* rings = nullptr;             // null: nobody watches or asks
  FrameSink* record = nullptr;        // null: not recorded
  std::vector<Listener> listeners{};  // judges, tests, the command line
  Pacer* pacer = nullptr;             // null: as fast as it goes; a real robot keeps its own time
  /// Control thread, each time the outcome changes; with the figures so far.
  std::function<void(algo::Outcome, const algo::Metrics&)> on_outcome{};
};

/// How long nothing has happened: nobody asked for anything, and the robot neither drives nor
/// moves nor is held for another reason than before.
class Stillness {
 public:
  /// True when that has lasted longer than `span` [s] at `t`; never when `span` is 0.
  bool lasts(const algo::Telemetry& t, double span);

 private:
  double since_ = 0;  // [s] of the last event
  algo::Mission mission_ = algo::Mission::Idle;
  algo::Hold hold_{};
};

/// One run in progress. It keeps no thread and waits for nothing but a real robot's deadline: who
/// owns it calls advance() when it asked to be called, one thread at a time.
class Run {
 public:
  using Clock = Pacer::Clock;
  /// When advance() wants to be called again.
  struct Next {
    enum class When : std::uint8_t {
      AtOnce,  // time runs as fast as it goes
      At,
      Asked,  // it is paused: at `time`, or sooner when something was asked for
      Over,
    };
    When when = When::AtOnce;
    Clock::time_point time{};  // but for AtOnce and Over
  };

  /// `robot`, `pipeline` and what `links` points to must outlive it.
  Run(algo::Robot& robot,
      algo::Pipeline& pipeline,
      const RunPolicy& policy,
      RunLinks links,
      std::stop_token stop);

  /// `first` requests are applied before the first tick. Once, before all else.
  void begin(const std::vector<algo::Request>& first);
  /// At most one period. Called too early it serves what was asked for and says when again.
  Next advance();
  /// Stops the robot. Once, after advance() said Over or instead of it.
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
  void news() const;
  bool over() const;

  algo::Robot& robot_;
  algo::Arming* arming_;    // of a real robot, which keeps its own time
  algo::Editing* editing_;  // null: its obstacles cannot be edited
  algo::Pipeline& pipeline_;
  RunPolicy policy_;
  RunLinks links_;
  std::stop_token stop_;
  Phase phase_ = Phase::Reset;
  FrameRef frame_{};                         // of the newest tick
  algo::Recycled<algo::Request> pending_{};  // accepted, for the next tick's record
  FreshOrders orders_{};
  double now_ = 0;  // [s] run clock, of the newest observation
  algo::MetricsRecorder metrics_{};
  RunResult result_{};
  Stillness stillness_{};
  std::optional<Clock::time_point> waits_since_{};  // for the record, with the newest tick
  bool impatient_ = false;  // the record kept a tick waiting too long and has taken none since
  bool broken_ = false;
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
