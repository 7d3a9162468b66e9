// sim/pacer.cpp: waits for deadlines, woken by a change of pace.
#include "sim/pacer.hpp"

#include <algorithm>
#include <cmath>

namespace sim {
namespace {

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

/// Single steps add up: two requests for one step each are two steps, however fast they come.
void Pacer::set(const algo::Pace& pace) {
  {
    const std::lock_guard lock(mutex_);
    const std::uint32_t left = pace_.paused && pace.single_steps > 0 ? pace_.single_steps : 0;
    pace_ = pace;
    if (!std::isfinite(pace_.speed) || pace_.speed < 0) pace_.speed = 1;
    pace_.single_steps = pace.paused ? pace.single_steps + left : 0;
    ++changes_;
    deadlines_.restart();
  }
  changed_.notify_all();
}

algo::Pace Pacer::pace() const {
  const std::lock_guard lock(mutex_);
  return pace_;
}

void Pacer::restart() {
  const std::lock_guard lock(mutex_);
  deadlines_.restart();
}

std::uint64_t Pacer::missed() const {
  const std::lock_guard lock(mutex_);
  return deadlines_.missed();
}

bool Pacer::wait(double seconds) {
  std::unique_lock lock(mutex_);
  for (;;) {
    const std::uint64_t seen = changes_;
    const auto changed = [this, seen] { return changes_ != seen; };
    if (pace_.paused) {
      if (pace_.single_steps == 0) {
        changed_.wait_for(lock, kPausedWait, changed);
        if (pace_.paused && pace_.single_steps == 0) return false;
        continue;
      }
      --pace_.single_steps;
      return true;
    }
    if (pace_.speed == 0) return true;
    const double wall = std::clamp(seconds / pace_.speed, 0.0, kLongestPeriod);
    const auto length =
        std::chrono::duration_cast<Deadlines::Clock::duration>(std::chrono::duration<double>(wall));
    const auto deadline = deadlines_.next(Deadlines::Clock::now(), length);
    if (!changed_.wait_until(lock, deadline, changed)) return true;
  }
}

}  // namespace sim
