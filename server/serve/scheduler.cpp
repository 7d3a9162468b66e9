// server/serve/scheduler.cpp: an ordered queue of deadlines, and a queue of runs without one.
#include "server/serve/scheduler.hpp"

#include <algorithm>

#include "drivers/real_time.hpp"
#include "server/serve/workers.hpp"

namespace server {
namespace {

constexpr int kFastNice = 5;     // ahead of the experiments, behind all else
constexpr int kTimedNice = -10;  // ahead of viewers and the record, which may be a little late

}  // namespace

Scheduler::Scheduler(std::size_t threads) {
  if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency());
  for (std::size_t i = 0; i < threads; ++i) {
    threads_.emplace_back([this](const std::stop_token& stop) { work_timed(stop); });
    threads_.emplace_back([this](const std::stop_token& stop) { work_fast(stop); });
  }
}

Scheduler::~Scheduler() {
  const std::lock_guard lock(mutex_);
  for (std::jthread& thread : threads_) thread.request_stop();
  wake_.notify_all();
  wake_fast_.notify_all();
}

void Scheduler::add(Task& task) {
  const std::lock_guard lock(mutex_);
  queue(task, Clock::now());
  wake_.notify_one();
}

void Scheduler::wake(Task& task) {
  const std::lock_guard lock(mutex_);
  if (task.place_ == Task::Place::Running) task.woken_ = true;
  if (task.place_ != Task::Place::Timed) return;
  take_out(task);
  queue(task, Clock::now());
  wake_.notify_one();
}

void Scheduler::remove(Task& task) {
  std::unique_lock lock(mutex_);
  if (task.place_ == Task::Place::Running) {
    task.leaving_ = true;
    done_.wait(lock, [&] { return task.place_ == Task::Place::Out; });
    return;
  }
  take_out(task);
}

void Scheduler::work_timed(const std::stop_token& stop) {
  drivers::ask_for_punctual_timers();
  drivers::name_this_thread("runs");
  give_way(kTimedNice);
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    if (!timed_.empty() && timed_.begin()->first <= Clock::now()) {
      Task& task = *timed_.begin()->second;
      take_out(task);
      // A thread may still wait for this task's deadline, but the first deadline is now another.
      if (idle_ > 0 && !timed_.empty()) wake_.notify_one();
      advance(task, false, lock);
      continue;
    }
    ++idle_;
    if (timed_.empty()) {
      wake_.wait(lock);
    } else {
      // A copy: another thread may take the task out while wait_until() still reads its deadline.
      const Clock::time_point due = timed_.begin()->first;
      wake_.wait_until(lock, due);
    }
    --idle_;
  }
}

void Scheduler::work_fast(const std::stop_token& stop) {
  drivers::name_this_thread("fast runs");
  give_way(kFastNice);
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    if (fast_.empty()) {
      wake_fast_.wait(lock);
      continue;
    }
    Task& task = *fast_.front();
    take_out(task);
    advance(task, true, lock);
  }
}

/// The caller holds the lock; it is released while the task runs.
void Scheduler::advance(Task& task, bool fast, std::unique_lock<std::mutex>& lock) {
  task.place_ = Task::Place::Running;
  lock.unlock();
  const Run::Next then = fast ? advance_fast(task) : task.advance();
  lock.lock();
  put_back(task, then);
}

Run::Next Scheduler::advance_fast(Task& task) {
  const Clock::time_point end = Clock::now() + kSlice;
  Run::Next then = task.advance();
  while (then.when == Run::Next::When::AtOnce && Clock::now() < end) then = task.advance();
  return then;
}

void Scheduler::put_back(Task& task, const Run::Next& next) {
  const bool woken = std::exchange(task.woken_, false);
  const bool leaves = std::exchange(task.leaving_, false);
  task.place_ = Task::Place::Out;
  if (leaves || next.when == Run::Next::When::Over) {
    if (leaves) done_.notify_all();
  } else if (next.when == Run::Next::When::AtOnce) {
    task.place_ = Task::Place::Fast;
    fast_.push_back(&task);
    wake_fast_.notify_one();
  } else {
    queue(task, woken ? Clock::now() : next.time);
    if (timed_.begin()->second == &task && idle_ > 0) wake_.notify_one();
  }
}

void Scheduler::queue(Task& task, Clock::time_point due) {
  task.place_ = Task::Place::Timed;
  task.due_ = due;
  timed_.emplace(due, &task);
}

void Scheduler::take_out(Task& task) {
  if (task.place_ == Task::Place::Timed) {
    timed_.erase({task.due_, &task});
  } else if (task.place_ == Task::Place::Fast) {
    std::erase(fast_, &task);
  }
  task.place_ = Task::Place::Out;
}

}  // namespace server
