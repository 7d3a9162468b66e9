// server/run/pacer.hpp: paces simulated or recorded time against the wall clock.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <stop_token>

#include "algo/health.hpp"

namespace server {

/// Absolute deadlines of successive periods. A pure value: the clock is an argument.
///
/// Each deadline is computed from the previous one, so lateness of less than a period does not
/// delay the next. Whole periods that went by are missed: they are counted and skipped, never made
/// up in a burst. Later deadlines keep the phase of the earlier ones.
class Deadlines {
 public:
  using Clock = std::chrono::steady_clock;

  /// Forgets earlier deadlines: the next one counts from `now`.
  void restart() { running_ = false; }
  /// The deadline `length` after the last one, plus as many whole periods as bring it to less than
  /// one period before `now`.
  Clock::time_point next(Clock::time_point now, Clock::duration length);
  /// Periods skipped since the start; restart() keeps the count.
  std::uint64_t missed() const { return missed_; }

 private:
  Clock::time_point last_{};
  std::uint64_t missed_ = 0;
  bool running_ = false;
};

struct Pace {
  bool paused = false;
  double speed = 1;                // times real time; 0 = as fast as possible
  std::uint32_t single_steps = 0;  // periods to run while paused
  bool operator==(const Pace&) const = default;
};

/// The pace of a run of simulated or recorded time. Any thread may call it, but due() and pass()
/// only the thread that advances the run.
class Pacer {
 public:
  using Clock = Deadlines::Clock;

  Pacer() = default;
  explicit Pacer(const Pace& pace) { set(pace); }

  /// Single steps add up: two requests for one step each are two steps, however fast they come.
  void set(const Pace& pace);
  Pace pace() const;
  /// The next period begins at the next call of due() or pass().
  void restart();

  /// Deadline of the current period of `seconds` of robot time; the period begins at the first
  /// call. Returns the smallest time point when the period may end at once, and nothing while
  /// paused without a step left.
  std::optional<Clock::time_point> due(double seconds, Clock::time_point now);
  /// True, once, when that deadline has come; the next period then begins.
  bool pass(double seconds, Clock::time_point now);

  /// Blocks until pass() is true; false if `stop` came first.
  bool wait(double seconds, const std::stop_token& stop = {});
  /// Blocks until `time`, a change of pace, or `stop`, whichever comes first.
  void sleep_until(Clock::time_point time, const std::stop_token& stop);

  /// Periods skipped because the caller came too late.
  std::uint64_t missed() const;
  /// How late pass() was after its deadlines.
  algo::LatenessHistogram lateness() const;

 private:
  std::optional<Clock::time_point> due_locked(double seconds, Clock::time_point now);

  mutable std::mutex mutex_{};
  std::condition_variable_any changed_{};
  Pace pace_{};  // single_steps counts the steps left
  std::uint64_t changes_ = 0;
  Deadlines deadlines_{};
  std::optional<Clock::time_point> deadline_{};  // of the current period
  algo::LatenessHistogram lateness_{};
};

}  // namespace server
