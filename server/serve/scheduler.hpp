// server/serve/scheduler.hpp: a few threads that advance many simulated runs, each when its time
// has come.
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

/// Runs with a deadline come first, the earliest before the others, on threads that do nothing
/// else. Those that go as fast as they can share what is left, a slice each in turn, on as many
/// threads that the system lets run behind those and the io thread.
///
/// All calls from any thread, but remove() not from one of its own.
class Scheduler {
 public:
  /// What is to be advanced. Never by two threads at once.
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
    bool leaving_ = false;          // while Running: take it out then
  };

  /// `threads` of each kind: 0 means as many as the machine has processors.
  explicit Scheduler(std::size_t threads = 0);
  /// All tasks must have been removed.
  ~Scheduler();
  Scheduler(const Scheduler&) = delete;
  Scheduler& operator=(const Scheduler&) = delete;

  /// It is advanced until it says that it is over, or until it is removed.
  void add(Task& task);
  /// Something was asked of it: it is advanced at once, whenever it wanted to be.
  void wake(Task& task);
  /// When this returns no thread advances it, nor will one. A task that is not there is no error.
  void remove(Task& task);

 private:
  using Clock = Run::Clock;
  static constexpr std::chrono::milliseconds kSlice{2};  // of those without deadlines

  void work_timed(const std::stop_token& stop);
  void work_fast(const std::stop_token& stop);
  void advance(Task& task, bool fast, std::unique_lock<std::mutex>& lock);
  static Run::Next advance_fast(Task& task);
  void put_back(Task& task, const Run::Next& next);
  void queue(Task& task, Clock::time_point due);
  void take_out(Task& task);

  std::mutex mutex_{};                   // guards what follows, and the private part of each task
  std::condition_variable wake_{};       // there is another first deadline
  std::condition_variable wake_fast_{};  // there is one without
  std::condition_variable done_{};       // a task that was to leave has come back
  std::set<std::pair<Clock::time_point, Task*>> timed_{};
  std::deque<Task*> fast_{};
  std::size_t idle_ = 0;                 // threads that wait for a deadline
  std::vector<std::jthread> threads_{};  // last: they use all of the above
};

}  // namespace server
