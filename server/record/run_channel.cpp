// server/record/run_channel.cpp: the ring between a control thread and the database thread.
#include "server/record/run_channel.hpp"

namespace server {

namespace detail {

void Doorbell::ring() {
  {
    const std::lock_guard lock(mutex_);
    rung_ = true;
  }
  condition_.notify_one();
}

void Doorbell::nudge() {
  if (asleep_.load()) ring();
}

void Doorbell::wait_until(std::chrono::steady_clock::time_point until) {
  std::unique_lock lock(mutex_);
  asleep_ = true;
  condition_.wait_until(lock, until, [&] { return rung_; });
  asleep_ = false;
  rung_ = false;
}

}  // namespace detail

RunChannel::RunChannel(db::RunId run,
                       db::NewRun what,
                       Keep keep,
                       std::size_t capacity,
                       std::shared_ptr<detail::Doorbell> bell)
    : run_(run),
      what_(std::move(what)),
      keep_(keep),
      half_(capacity / 2),
      ring_(capacity),
      bell_(std::move(bell)) {}

RunChannel::~RunChannel() {
  ring_.consume_all([](const Pushed& pushed) { pushed.frame->release(); });
}

bool RunChannel::push(FrameHandle& frame) {
  if (over_.load(std::memory_order_acquire)) {
    frame.reset();
    return true;
  }
  const bool after_pause = paused_.load(std::memory_order_relaxed);
  const bool taken = ring_.push({frame.get(), after_pause});
  if (taken) frame.detach();
  // A gap that is partly a fault counts as a fault.
  lost_ = !taken;
  if (after_pause) paused_.store(false, std::memory_order_relaxed);
  if (!taken || ring_.write_available() <= half_) bell_->nudge();
  return taken;
}

void RunChannel::pause() {
  if (!lost_ && !paused_.load(std::memory_order_relaxed)) {
    paused_.store(true, std::memory_order_relaxed);
  }
}

void RunChannel::close(db::RunEnd end, std::uint64_t ticks) {
  end_ = std::move(end);
  ticks_ = ticks;
  closed_.store(true, std::memory_order_release);
  bell_->ring();
}

std::string RunChannel::problem() const {
  if (!failed()) return {};
  const std::lock_guard lock(mutex_);
  return problem_;
}

void RunChannel::fail(const std::string& why) {
  {
    const std::lock_guard lock(mutex_);
    problem_ = why;
  }
  failed_.store(true, std::memory_order_release);
}

void RunChannel::recover() {
  if (!broken_) failed_.store(false, std::memory_order_release);
}

std::string RunChannel::incomplete() const {
  const std::lock_guard lock(mutex_);
  return failed() ? problem_ : loss_;
}

void RunChannel::lose(const std::string& why) {
  const std::lock_guard lock(mutex_);
  if (loss_.empty()) loss_ = why;
}

RecordStatus RunChannel::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

bool RunChannel::tell(RecordStatus status) {
  const std::lock_guard lock(mutex_);
  if (status == status_) return false;
  status_ = std::move(status);
  return true;
}

/// The gap after the last stored tick and before `tick`.
db::Gap RunChannel::gap_until(std::uint64_t tick, bool paused) const {
  db::Gap gap{.cause = db::GapCause::Behind, .sentence = "The store took the ticks too slowly."};
  if (missing_) {
    gap = *missing_;
  } else if (paused) {
    gap = {.cause = db::GapCause::Pause, .sentence = "Nothing happened: the record paused."};
  }
  gap.first_tick = next_tick_;
  gap.last_tick = tick - 1;
  return gap;
}

}  // namespace server
