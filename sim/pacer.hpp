// sim/pacer.hpp: how fast simulated or recorded time runs against the wall clock.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>

#include "algo/robot.hpp"

namespace sim {

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

/// Makes the calling thread keep the pace that another thread sets.
///
/// wait() belongs to one thread; set() may come from any.
class Pacer {
 public:
  /// Longest time that wait() blocks while paused, so that its caller can serve requests.
  static constexpr std::chrono::milliseconds kPausedWait{20};

  void set(const algo::Pace& pace);
  algo::Pace pace() const;
  /// The next period counts from the moment it is waited for.
  void restart();
  /// Periods of wall time that went by unused because the caller came too late.
  std::uint64_t missed() const;
  /// Waits for the end of a period of `seconds` of robot time. False when paused and no single step
  /// is left: no period has gone by.
  bool wait(double seconds);

 private:
  mutable std::mutex mutex_{};
  std::condition_variable changed_{};
  algo::Pace pace_{};  // single_steps counts those left
  std::uint64_t changes_ = 0;
  Deadlines deadlines_{};
};

}  // namespace sim
