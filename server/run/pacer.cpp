// server/run/pacer.cpp: computes deadlines and waits for them; a change of pace wakes the wait.
#include "server/run/pacer.hpp"

#include <algorithm>
#include <cmath>

namespace server {
namespace {

constexpr std::chrono::seconds kLongestSleep{1};
constexpr double kLongestPeriod = 3600;  // [s] of wall time; keeps the conversion in range

}  // namespace

Deadlines::Clock::time_point Deadlines::next(Clock::time_point now, Clock::duration length) {
  if (!running_) last_ = now;
  running_ = true;
  last_ += length;
  if (length > Clock::duration::zero() && now - last_ >= length) {
    const auto skipped = (now - last_) / length;
    last_ += skipped * length;
    missed_ += static_cast<std::uint64_t>(skipped);
  }
  return last_;
}

void Pacer::set(const Pace& pace) {
  {
    const std::lock_guard lock(mutex_);
    const std::uint32_t left = pace_.paused && pace.single_steps > 0 ? pace_.single_steps : 0;
    pace_ = pace;
    if (!std::isfinite(pace_.speed) || pace_.speed < 0) pace_.speed = 1;
    pace_.single_steps = pace.paused ? pace.single_steps + left : 0;
    ++changes_;
    deadlines_.restart();
    deadline_.reset();
  }
  changed_.notify_all();
}

Pace Pacer::pace() const {
  const std::lock_guard lock(mutex_);
  return pace_;
}

void Pacer::restart() {
  const std::lock_guard lock(mutex_);
  deadlines_.restart();
  deadline_.reset();
}

std::uint64_t Pacer::missed() const {
  const std::lock_guard lock(mutex_);
  return deadlines_.missed();
}

algo::LatenessHistogram Pacer::lateness() const {
  const std::lock_guard lock(mutex_);
  return lateness_;
}

std::optional<Pacer::Clock::time_point> Pacer::due_locked(double seconds, Clock::time_point now) {
  if (pace_.paused && pace_.single_steps == 0) return std::nullopt;
  if (pace_.paused || pace_.speed == 0) return Clock::time_point::min();
  if (!deadline_) {
    const double wall = std::clamp(seconds / pace_.speed, 0.0, kLongestPeriod);
    deadline_ = deadlines_.next(
        now, std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(wall)));
  }
  return deadline_;
}

std::optional<Pacer::Clock::time_point> Pacer::due(double seconds, Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  return due_locked(seconds, now);
}

bool Pacer::pass(double seconds, Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  const auto due = due_locked(seconds, now);
  if (!due || *due > now) return false;
  if (deadline_) lateness_.add(std::chrono::duration<double>(now - *deadline_).count());
  deadline_.reset();
  if (pace_.paused) --pace_.single_steps;
  return true;
}

bool Pacer::wait(double seconds, const std::stop_token& stop) {
  while (!pass(seconds, Clock::now())) {
    if (stop.stop_requested()) return false;
    const Clock::time_point now = Clock::now();
    sleep_until(due(seconds, now).value_or(now + kLongestSleep), stop);
  }
  return true;
}

void Pacer::sleep_until(Clock::time_point time, const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  const std::uint64_t seen = changes_;
  changed_.wait_until(lock, stop, time, [this, seen] { return changes_ != seen; });
}

}  // namespace server
