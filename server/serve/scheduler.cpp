// server/serve/scheduler.cpp: an ordered queue of deadlines, and a row of those without.
#include "server/serve/scheduler.hpp"

#include <algorithm>
#include <utility>

#include "drivers/real_time.hpp"

namespace server {

Scheduler::Scheduler(std::size_t threads) {
  if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency());
  for (std::size_t i = 0; i < threads; ++i) {
    threads_.emplace_back([this](const std::stop_token& stop) { work(stop); });
  }
}

Scheduler::~Scheduler() {
  const std::lock_guard lock(mutex_);
  for (std::jthread& thread : threads_) thread.request_stop();
  wake_.notify_all();
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

void Scheduler::work(const std::stop_token& stop) {
  drivers::ask_for_punctual_timers();
  drivers::name_this_thread("runs");
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    if (Task* const task = next(Clock::now())) {
      const bool fast = task->place_ == Task::Place::Fast;
      take_out(*task);
      task->place_ = Task::Place::Running;
      // Who waits may wait for this task's deadline; there is another first one now.
      if (idle_ > 0 && (!timed_.empty() || !fast_.empty())) wake_.notify_one();
      lock.unlock();
      const Run::Next then = advance(*task, fast);
      lock.lock();
      put_back(*task, then);
      continue;
    }
    ++idle_;
    if (timed_.empty()) {
      wake_.wait(lock);
    } else {
      wake_.wait_until(lock, timed_.begin()->first);
    }
    --idle_;
  }
}

/// The one whose turn it is; null when there is time to wait.
Scheduler::Task* Scheduler::next(Clock::time_point now) {
  if (!timed_.empty() && timed_.begin()->first <= now) return timed_.begin()->second;
  return fast_.empty() ? nullptr : fast_.front();
}

Run::Next Scheduler::advance(Task& task, bool fast) {
  Run::Next then = task.advance();
  const Clock::time_point end = Clock::now() + kSlice;
  while (fast && then.when == Run::Next::When::AtOnce) {
    const Clock::time_point now = Clock::now();
    if (now >= end || now.time_since_epoch().count() >= first_due_.load()) break;
    then = task.advance();
  }
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
  } else {
    queue(task, woken ? Clock::now() : next.time);
  }
}

void Scheduler::queue(Task& task, Clock::time_point due) {
  task.place_ = Task::Place::Timed;
  task.due_ = due;
  timed_.emplace(due, &task);
  note_first();
}

void Scheduler::take_out(Task& task) {
  if (task.place_ == Task::Place::Timed) {
    timed_.erase({task.due_, &task});
    note_first();
  } else if (task.place_ == Task::Place::Fast) {
    std::erase(fast_, &task);
  }
  task.place_ = Task::Place::Out;
}

void Scheduler::note_first() {
  const auto first = timed_.empty() ? Clock::time_point::max() : timed_.begin()->first;
  first_due_.store(first.time_since_epoch().count());
}

}  // namespace server
