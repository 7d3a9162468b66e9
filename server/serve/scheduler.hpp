// server/serve/scheduler.hpp: a few threads that advance many simulated runs, each at its due time.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <set>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>

#include "server/run/runner.hpp"

namespace server {

/// Runs with a deadline come first, earliest deadline first, on their own threads. Runs without one
/// go as fast as possible and share the remaining time in turn, one slice each. They have as many
/// threads, at a lower priority than those and the io thread.
///
/// Any thread may make any call, except remove() from one of the scheduler's own threads.
class Scheduler {
 public:
  /// The work to advance. Never advanced by two threads at once.
  class Task {
   public:
    virtual ~Task() = default;
    virtual Run::Next advance() = 0;

   private:
    friend class Scheduler;
    enum class Place : std::uint8_t { Out, Timed, Fast, Running };
    Place place_ = Place::Out;
    Run::Clock::time_point due_{};  // while Timed
    bool woken_ = false;            // while Running: advance it again at once
    bool leaving_ = false;          // while Running: remove it afterwards
  };

  /// `threads` of each kind; 0: one per processor.
  explicit Scheduler(std::size_t threads = 0);
  /// All tasks must have been removed.
  ~Scheduler();
  Scheduler(const Scheduler&) = delete;
  Scheduler& operator=(const Scheduler&) = delete;

  /// Advances the task until it returns Over or is removed.
  void add(Task& task);
  /// The task has requests: advances it at once, before its due time.
  void wake(Task& task);
  /// After this returns, no thread advances the task. An unknown task is no error.
  void remove(Task& task);

 private:
  using Clock = Run::Clock;
  static constexpr std::chrono::milliseconds kSlice{2};  // for runs without deadlines

  void work_timed(const std::stop_token& stop);
  void work_fast(const std::stop_token& stop);
  void advance(Task& task, bool fast, std::unique_lock<std::mutex>& lock);
  static Run::Next advance_fast(Task& task);
  void put_back(Task& task, const Run::Next& next);
  void queue(Task& task, Clock::time_point due);
  void take_out(Task& task);

  std::mutex mutex_{};                   // guards the members below and each task's private part
  std::condition_variable wake_{};       // the first deadline has changed
  std::condition_variable wake_fast_{};  // a task without a deadline has come
  std::condition_variable done_{};       // a leaving task has come back
  std::set<std::pair<Clock::time_point, Task*>> timed_{};
  std::deque<Task*> fast_{};
  std::size_t idle_ = 0;                 // threads waiting for a deadline
  std::vector<std::jthread> threads_{};  // last: they use all of the above
};

}  // namespace server
