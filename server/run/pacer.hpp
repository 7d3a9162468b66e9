// server/run/pacer.hpp: how fast simulated or recorded time runs against the wall clock.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <stop_token>

#include "algo/health.hpp"

namespace server {

/// Absolute deadlines of successive periods; a pure value, the clock is an argument.
///
/// Each deadline follows from the one before, so that lateness of less than a period does not delay
/// the next. Whole periods that went by are missed: they are counted and left out, never made good
/// in a burst, and the row goes on in step with its old deadlines.
class Deadlines {
 public:
  using Clock = std::chrono::steady_clock;

  /// Forgets the row: the next deadline counts from `now`.
  void restart() { running_ = false; }
  /// The deadline `length` after the last one, or so many periods later that it lies less than one
  /// before `now`.
  Clock::time_point next(Clock::time_point now, Clock::duration length);
  /// Periods left out since the start; restart() keeps the count.
  std::uint64_t missed() const { return missed_; }

 private:
  Clock::time_point last_{};
  std::uint64_t missed_ = 0;
  bool running_ = false;
};

struct Pace {
  bool paused = false;
  double speed = 1;                // times real time; 0 = as fast as it goes
  std::uint32_t single_steps = 0;  // periods to run while paused
  bool operator==(const Pace&) const = default;
};

/// The pace of a run of simulated or recorded time. All calls from any thread; due() and pass() are
/// made by one at a time, the run's.
class Pacer {
 public:
  using Clock = Deadlines::Clock;

  Pacer() = default;
  explicit Pacer(const Pace& pace) { set(pace); }

  /// Single steps add up: two requests for one step each are two steps, however fast they come.
  void set(const Pace& pace);
  Pace pace() const;
  /// The next period counts from the moment it is asked for.
  void restart();

  /// When the period of `seconds` of robot time that is under way ends; it begins when first asked
  /// for. The least time there is when it may end at once; nothing while paused without a step
  /// left.
  std::optional<Clock::time_point> due(double seconds, Clock::time_point now);
  /// True, once, when that time has come: the next period is under way.
  bool pass(double seconds, Clock::time_point now);

  /// Blocks until pass() is true; false when `stop` came first.
  bool wait(double seconds, const std::stop_token& stop = {});
  /// Blocks until `time`, a change of pace, or `stop`, whichever comes first.
  void sleep_until(Clock::time_point time, const std::stop_token& stop);

  /// Periods of wall time that went by unused because the caller came too late.
  std::uint64_t missed() const;
  /// How late pass() was for its deadlines.
  algo::LatenessHistogram lateness() const;

 private:
  std::optional<Clock::time_point> due_locked(double seconds, Clock::time_point now);

  mutable std::mutex mutex_{};
  std::condition_variable_any changed_{};
  Pace pace_{};  // single_steps counts those left
  std::uint64_t changes_ = 0;
  Deadlines deadlines_{};
  std::optional<Clock::time_point> deadline_{};  // of the period under way
  algo::LatenessHistogram lateness_{};
};

}  // namespace server
