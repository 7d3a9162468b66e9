// server/recorder.cpp: the database thread.
#include "server/recorder.hpp"

#include <algorithm>
#include <exception>

namespace server {

namespace {

using std::chrono::milliseconds;

// How long the database thread sleeps when nobody rings: short against the commit interval, and
// long enough to cost nothing. A ring that fills faster rings at half.
constexpr milliseconds kNap{20};
// What one commit interval may spend on deleting old runs.
constexpr milliseconds kSweepTime{400};

}  // namespace

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

RunChannel::RunChannel(db::RunId run, std::size_t capacity, std::shared_ptr<detail::Doorbell> bell)
    : run_(run), half_(capacity / 2), ring_(capacity), bell_(std::move(bell)) {}

RunChannel::~RunChannel() {
  ring_.consume_all([](RecordedFrame* frame) { frame->release(); });
}

bool RunChannel::push(FrameHandle& frame) {
  if (failed()) {
    frame.reset();
    return true;
  }
  const bool taken = ring_.push(frame.get());
  if (taken) frame.detach();
  if (!taken || ring_.write_available() <= half_) bell_->nudge();
  return taken;
}

void RunChannel::close(db::RunEnd end) {
  end_ = std::move(end);
  closed_.store(true, std::memory_order_release);
  bell_->ring();
}

void RunChannel::fail(const std::string& why) {
  if (failed()) return;
  problem_ = why;
  failed_.store(true, std::memory_order_release);
}

Recorder::Recorder(const std::string& path, RecorderOptions options)
    : options_(std::move(options)),
      store_(path, options_.store),
      interrupted_(store_.interrupted()),
      thread_([this] { work(); }) {}

Recorder::~Recorder() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  bell_->ring();
  thread_.join();
}

std::shared_ptr<RunChannel> Recorder::open(const db::NewRun& what) {
  return ask([&](db::RunStore& store) {
    const db::RunId run = store.begin_run(what);
    store.commit();
    return add_channel(run);
  });
}

std::shared_ptr<RunChannel> Recorder::open(db::RunId queued, const std::string& started) {
  return ask([&](db::RunStore& store) {
    store.start_run(queued, started);
    store.commit();
    return add_channel(queued);
  });
}

std::shared_ptr<RunChannel> Recorder::add_channel(db::RunId run) {
  channels_.push_back(std::make_shared<RunChannel>(run, options_.ring_frames, bell_));
  return channels_.back();
}

void Recorder::post(Job job) {
  {
    const std::lock_guard lock(mutex_);
    if (stopping_) throw db::StoreError("The server is stopping; nothing more is recorded.");
    jobs_.push_back(std::move(job));
  }
  bell_->ring();
}

void Recorder::flush() {
  ask([this](db::RunStore&) {
    take_frames();
    end_closed();
    commit();
  });
}

void Recorder::report(const std::string& sentence) const {
  if (options_.report) options_.report(sentence);
}

/// Runs `action`; a failing database costs the runs it dropped, not the thread.
template <typename Action>
void Recorder::guarded(const Action& action) {
  try {
    action();
  } catch (const std::exception& error) {
    report(error.what());
    drop_lost(error.what());
  }
}

/// Fails the channels whose runs the store no longer records.
void Recorder::drop_lost(const std::string& why) {
  for (const auto& channel : channels_) {
    if (channel->failed() || channel->full_ || store_.recording(channel->run())) continue;
    channel->fail(why);
    lost_.emplace_back(
        channel->run(),
        db::RunEnd{.status = db::RunStatus::Failed, .outcome = "failed", .reason = why});
  }
}

void Recorder::work() {
  for (bool last = false; !last;) {
    {
      const std::lock_guard lock(mutex_);
      last = stopping_;
    }
    run_jobs();
    take_frames();
    end_closed();
    if (Clock::now() >= commit_due_) {
      end_lost();
      commit();
      make_room();
    }
    if (!last) {
      bell_->wait_until(channels_.empty() ? commit_due_
                                          : std::min(Clock::now() + kNap, commit_due_));
    }
  }
  stop_all();
}

void Recorder::run_jobs() {
  std::vector<Job> jobs;
  {
    const std::lock_guard lock(mutex_);
    jobs.swap(jobs_);
  }
  for (const Job& job : jobs) {
    guarded([&] {
      job(store_);
      store_.commit();
    });
    // ask() passes the error on to its caller, and yet it may have cost a recording.
    drop_lost("The run store failed; what it held since its last commit is lost.");
  }
}

void Recorder::take_frames() {
  for (const auto& channel : channels_) take_frames(*channel);
}

void Recorder::take_frames(RunChannel& channel) {
  // Only what is here now, so that one fast run does not keep the others and the commit waiting.
  for (std::size_t left = channel.ring_.read_available(); left > 0; --left) {
    RecordedFrame* popped = nullptr;
    if (!channel.ring_.pop(popped)) return;
    const FrameHandle frame(popped);
    if (channel.failed() || channel.full_) continue;
    ++channel.taken_;
    guarded([&] {
      try {
        store_.append_tick(channel.run(), frame->row(), frame->bytes(), frame->windows());
      } catch (const db::DatabaseError&) {
        throw;
      } catch (const std::exception& error) {
        // A frame that cannot be stored ends its own run and no other.
        channel.fail(error.what());
        lost_.emplace_back(
            channel.run(),
            db::RunEnd{
                .status = db::RunStatus::Failed, .outcome = "failed", .reason = error.what()});
        report(error.what());
      }
    });
  }
}

void Recorder::end_closed() {
  for (std::size_t i = 0; i < channels_.size();) {
    RunChannel& channel = *channels_[i];
    // In this order: whoever closed and then let go is seen to have closed, and what was pushed
    // before close() is seen in the ring.
    const bool held = channels_[i].use_count() > 1;
    const bool closed = channel.closed_.load(std::memory_order_acquire);
    if (!closed && held) {
      ++i;
      continue;
    }
    take_frames(channel);
    if (!channel.failed() && !channel.full_) {
      guarded([&] {
        store_.end_run(channel.run(),
                       closed ? channel.end_
                              : db::RunEnd{.status = db::RunStatus::Failed,
                                           .outcome = "failed",
                                           .reason = "The run broke off without a result."});
        store_.commit();
      });
    }
    channels_.erase(channels_.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

/// Marks failed runs in the store, as soon as it takes writes again.
void Recorder::end_lost() {
  while (!lost_.empty()) {
    try {
      store_.end_run(lost_.back().first, lost_.back().second);
      store_.commit();
    } catch (const db::DatabaseError&) {
      drop_lost("The run store failed.");
      return;  // still not; the next start will find the run unfinished and say so
    } catch (const db::StoreError&) {
      // Its first commit was lost too: there is nothing to mark.
    }
    lost_.pop_back();
  }
}

void Recorder::commit() {
  commit_due_ = Clock::now() + options_.commit_interval;
  guarded([&] { store_.commit(); });
}

/// Only runs in progress are left and they are too much: the longest is recorded no further, and
/// may then be deleted like any other. Its robot goes on; nobody meant to keep it all.
void Recorder::cut_longest() {
  const auto longest =
      std::max_element(channels_.begin(), channels_.end(), [](const auto& a, const auto& b) {
        return std::pair(!a->full_, a->taken_) < std::pair(!b->full_, b->taken_);
      });
  if (longest == channels_.end() || (*longest)->full_) return;
  RunChannel& channel = **longest;
  const std::string why = "Run " + std::to_string(channel.run()) +
                          " fills the run store alone: from here on it is not recorded.";
  store_.end_run(channel.run(), {.outcome = "stopped", .reason = why});
  store_.commit();
  channel.full_ = true;
  report(why);
}

void Recorder::make_room() {
  guarded([&] {
    // What people deleted goes first: nothing else has to go while that is still there. Every slice
    // commits, so the frames that came meanwhile are as safe as without it.
    const auto until = Clock::now() + kSweepTime;
    bool more = store_.sweep();
    while (more && Clock::now() < until) {
      take_frames();
      more = store_.sweep();
    }
    if (more || options_.retention_bytes == 0) return;
    if (const auto run = store_.retire_oldest(options_.retention_bytes)) {
      report("Deleted run " + std::to_string(run->id) + " (" + run->what.scenario + ", " +
             run->what.started + ", " + std::to_string(run->ticks) +
             " ticks): the run store is full.");
    } else if (store_.used_bytes() > options_.retention_bytes) {
      cut_longest();
    }
  });
}

void Recorder::stop_all() {
  for (const auto& channel : channels_) {
    if (channel->failed() || channel->full_) continue;
    guarded([&] {
      store_.end_run(channel->run(),
                     {.status = db::RunStatus::Interrupted,
                      .outcome = "stopped",
                      .reason = "The server was stopped in the middle of this run."});
    });
  }
  end_lost();
  commit();
  for (const auto& channel : channels_) channel->fail("The server was stopped.");
  channels_.clear();
}

}  // namespace server
