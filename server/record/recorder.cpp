// server/record/recorder.cpp: the database thread.
#include "server/record/recorder.hpp"

#include <algorithm>

#include "server/run/io_thread.hpp"

namespace server {

namespace {

using std::chrono::milliseconds;

// The database thread's sleep without a ring of the bell: short against the commit interval, and
// long enough to cost nothing. A frame ring that fills faster rings the bell when half full.
constexpr milliseconds kNap{20};
// Longest wait of a stopping recorder for a locked store.
constexpr milliseconds kLastPatience{2000};
// Most runs that began and ended while the store failed and still wait for it. Beyond that the
// oldest are dropped.
constexpr std::size_t kMostWaiting = 64;
// [bytes] of unpacked frames that never make a commit due early.
constexpr std::uint64_t kLeastUncommitted = std::uint64_t{1} << 20;
// Time in one commit interval for jobs that waited for the store.
constexpr milliseconds kLaterTime{100};

/// [bytes] that may be kept, as far as known at the start.
std::uint64_t most_kept(const std::string& path, const RecorderOptions& options) {
  const std::uint64_t limit = options.retention_bytes > 0 ? options.retention_bytes : UINT64_MAX;
  const std::uint64_t disk = options.disk(path).total;
  return disk > 0 ? std::min(limit, disk) : limit;
}

/// Keeps the write-ahead log a small part of `most`.
db::StoreOptions store_options(std::uint64_t most,
                               const RecorderOptions& options,
                               const std::shared_ptr<db::RunNumbers>& numbers) {
  constexpr std::uint64_t kPageBytes = 4096;
  constexpr std::uint64_t kFewestPages = 16;
  db::StoreOptions store = options.store;
  store.numbers = numbers;
  store.log_pages = static_cast<std::uint32_t>(
      std::clamp<std::uint64_t>(most / 16 / kPageBytes, kFewestPages, store.log_pages));
  return store;
}

constexpr const char* kStopping = "The server is stopping; nothing more is recorded.";

}  // namespace

Recorder::Recorder(const std::string& path, RecorderOptions options)
    : options_(std::move(options)),
      most_uncommitted_(std::max(kLeastUncommitted, most_kept(path, options_) / 16)),
      store_(path,
             store_options(most_kept(path, options_), options_, numbers_),
             db::RunStore::Closed{}) {
  open_store();
  interrupted_ = store_.interrupted();
  takes_more_ = !ailment_;
  publish();
  thread_ = std::thread([this] { work(); });
}

Recorder::~Recorder() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  bell_->ring();
  thread_.join();
}

std::shared_ptr<RunChannel> Recorder::begin(const db::NewRun& what) {
  auto channel = std::make_shared<RunChannel>(
      numbers_->take(), what, Keep::NewestHour, options_.ring_frames, bell_);
  {
    const std::lock_guard lock(mutex_);
    if (stopping_) throw db::StoreError(kStopping);
    arrivals_.push_back(channel);
  }
  bell_->ring();
  return channel;
}

std::shared_ptr<RunChannel> Recorder::open(const db::NewRun& what) {
  net::not_on_io_thread("Waiting for the run store");
  return ask([&](db::RunStore& store) {
    const db::RunId run = store.begin_run(what);
    store.commit();
    return add_channel(run, what);
  });
}

std::shared_ptr<RunChannel> Recorder::open(db::RunId queued, const db::NewRun& what) {
  net::not_on_io_thread("Waiting for the run store");
  return ask([&](db::RunStore& store) {
    db::RunId run = queued;
    if (store.status_of(queued)) {
      store.start_run(queued, what.started);
    } else {
      run = store.begin_run(what, queued);
    }
    store.commit();
    return add_channel(run, what);
  });
}

std::shared_ptr<RunChannel> Recorder::add_channel(db::RunId run, const db::NewRun& what) {
  channels_.push_back(
      std::make_shared<RunChannel>(run, what, Keep::Whole, options_.ring_frames, bell_));
  return channels_.back();
}

void Recorder::post(Job job) {
  {
    const std::lock_guard lock(mutex_);
    if (stopping_) throw db::StoreError(kStopping);
    jobs_.push_back(std::move(job));
  }
  bell_->ring();
}

void Recorder::post_when_well(Job job) {
  post([this, job = std::move(job)](db::RunStore& /*store*/) { later_.push_back(job); });
}

bool Recorder::flush(milliseconds patience) {
  const auto until = Clock::now() + patience;
  for (;;) {
    const bool done = ask([this](db::RunStore& /*store*/) {
      take_arrivals();
      take_frames();
      end_closed();
      commit();
      const bool locked = ailment_ && ailment_->trouble == db::Trouble::Busy;
      return !locked && std::ranges::none_of(channels_, [&](const auto& channel) {
        return waits(*channel) && channel->ring_.read_available() > 0;
      });
    });
    if (done || Clock::now() >= until) return done;
    std::this_thread::sleep_for(kNap);
  }
}

/// Runs `action`. If the database fails, uncommitted data is lost, but the thread goes on.
template <typename Action>
void Recorder::guarded(const Action& action) {
  try {
    action();
  } catch (const db::DatabaseError& error) {
    store_.take_failure();
    note_trouble(error);
  } catch (const std::exception& error) {
    report(error.what());
  }
}

void Recorder::work() {
  for (bool last = false; !last;) {
    {
      const std::lock_guard lock(mutex_);
      last = stopping_;
    }
    // No error here may end the program: a robot may be driving.
    try {
      work_once(last);
    } catch (const std::exception& error) {
      report(std::string("The record's thread: ") + error.what());
    }
  }
  stop_all();
}

void Recorder::work_once(bool last) {
  recover();
  run_jobs();
  take_arrivals();
  take_frames();
  end_closed();
  if (Clock::now() >= round_due_ || uncommitted_ > most_uncommitted_) {
    round_due_ = Clock::now() + options_.commit_interval;
    run_later();
    look_at_file();
    commit();
    make_room();
    publish();
  }
  if (last) return;
  bell_->wait_until(channels_.empty() ? round_due_ : std::min(Clock::now() + kNap, round_due_));
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
    // ask() passes the error to its caller, but the error may also have ended a recording.
    if (const auto failure = store_.take_failure()) note_trouble(*failure);
    // Many jobs must not delay the commit of frames that came meanwhile.
    take_frames();
    if (Clock::now() >= commit_due_) commit();
  }
}

/// Commits jobs together, one slice at a time: ten thousand cancelled runs must not delay the
/// frames by as many commits. If a slice fails, all of it is done again.
void Recorder::run_later() {
  const auto until = Clock::now() + kLaterTime;
  std::size_t done = 0;
  while (done < later_.size() && !ailment_ && Clock::now() < until) {
    guarded([&] { later_[done](store_); });
    ++done;
    take_frames();
  }
  if (done == 0 || ailment_) return;
  guarded([&] { store_.commit(); });
  if (!ailment_) later_.erase(later_.begin(), later_.begin() + static_cast<std::ptrdiff_t>(done));
}

/// A full store may lack the pages for the gaps of its runs. So a slice of the jobs that wait for a
/// store that is well comes first, deletions among them. Throws DatabaseError; then all of the
/// slice is done again.
void Recorder::make_way() {
  const auto until = Clock::now() + kLaterTime;
  std::size_t done = 0;
  for (; done < later_.size() && Clock::now() < until; ++done) {
    try {
      later_[done](store_);
    } catch (const db::DatabaseError&) {
      throw;
    } catch (const std::exception& error) {
      report(error.what());
    }
  }
  store_.commit();
  later_.erase(later_.begin(), later_.begin() + static_cast<std::ptrdiff_t>(done));
}

/// Writes the rows of live runs that began meanwhile, at once.
void Recorder::take_arrivals() {
  std::vector<std::shared_ptr<RunChannel>> arrivals;
  {
    const std::lock_guard lock(mutex_);
    arrivals.swap(arrivals_);
  }
  for (auto& channel : arrivals) {
    channels_.push_back(channel);
    channel->unheard_ = ailment_.has_value();
    if (ailment_ && ailment_->trouble != db::Trouble::Busy) channel->fail(ailment_->sentence);
    if (full_) channel->fail(*full_);
    guarded([&] {
      if (ailment_) return;
      resume(*channel);
      store_.commit();
    });
  }
  if (!arrivals.empty()) publish();
}

void Recorder::take_frames(std::size_t most) {
  for (const auto& channel : channels_) take_frames(*channel, most);
}

/// True for a run to be kept whole that has ended. The rest of its ring is stored even without
/// room, so that the run ends and can be deleted.
bool Recorder::last_of_whole(const RunChannel& channel) const {
  return channel.keep_ == Keep::Whole && options_.wait_for_room &&
         channel.closed_.load(std::memory_order_acquire);
}

/// True if the frames of a run stay in its ring for now.
bool Recorder::waits(const RunChannel& channel) const {
  if (ailment_) return ailment_->trouble == db::Trouble::Busy;
  return full_ && channel.keep_ == Keep::Whole && options_.wait_for_room && !last_of_whole(channel);
}

void Recorder::take_frames(RunChannel& channel, std::size_t most) {
  // Takes only frames already in the ring, so that one fast run does not delay the others and the
  // commit.
  std::size_t left = std::min(channel.ring_.read_available(), most);
  if (left == 0 || waits(channel)) return;
  const bool stored = !full_ || last_of_whole(channel);
  if (!ailment_ && stored && !channel.broken_) guarded([&] { store_.begin(); });
  if (waits(channel)) return;  // locked: frames stay in the ring
  for (; left > 0; --left) {
    RunChannel::Pushed pushed{};
    if (!channel.ring_.pop(pushed)) return;
    const FrameHandle frame(pushed.frame);
    keep(channel, *frame.get(), pushed.after_pause);
  }
}

void Recorder::keep(RunChannel& channel, const RecordedFrame& frame, bool after_pause) {
  if (channel.broken_) return;
  if (ailment_ || (full_ && !last_of_whole(channel))) {
    channel.missing_ = {.cause = ailment_ ? db::GapCause::Failed : db::GapCause::Full,
                        .sentence = without_folder(ailment_ ? ailment_->sentence : *full_)};
    channel.lose(channel.missing_->sentence);
    return;
  }
  guarded([&] {
    try {
      resume(channel);
      const std::uint64_t tick = frame.tick();
      if (tick > channel.next_tick_) {
        note_gap(channel, tick, after_pause);
      }
      store_.append_tick(channel.run(), tick, frame.time(), frame.bytes(), frame.windows());
      uncommitted_ += frame.bytes().size();
      channel.next_tick_ = tick + 1;
      channel.missing_.reset();
    } catch (const db::DatabaseError&) {
      throw;
    } catch (const std::exception& error) {
      // A frame that cannot be stored ends the record of its own run only.
      channel.broken_ = true;
      channel.fail(error.what());
      channel.lose(error.what());
      report(error.what());
      store_.end_run(
          channel.run(),
          {.status = db::RunStatus::Failed, .outcome = "failed", .reason = error.what()});
    }
  });
}

/// Stores the gap after the run's last stored tick and before `tick`.
void Recorder::note_gap(RunChannel& channel, std::uint64_t tick, bool paused) {
  const db::Gap gap = channel.gap_until(tick, paused);
  if (gap.cause != db::GapCause::Pause) channel.lose(gap.sentence);
  store_.note_gap(channel.run(), gap);
}

/// Resumes a run that the store does not record now, in its row or, if that is gone, in a new one.
void Recorder::resume(RunChannel& channel) {
  if (channel.broken_ || store_.recording(channel.run())) return;
  channel.unheard_ = false;
  if (const auto next = store_.resume_run(channel.run())) {
    channel.next_tick_ = *next;
    return;
  }
  channel.next_tick_ = 0;
  channel.run_.store(store_.begin_run(channel.what_, channel.run()), std::memory_order_release);
}

/// Writes the gap before a run's end, then the end. False if the store does not take it.
bool Recorder::end(RunChannel& channel, const db::RunEnd& end, std::uint64_t ticks) {
  bool ended = channel.broken_;
  guarded([&] {
    if (ended || ailment_) return;
    resume(channel);
    if (ticks > channel.next_tick_) {
      note_gap(channel, ticks, channel.paused_);
    }
    store_.end_run(channel.run(), end);
    store_.commit();
    ended = true;
  });
  return ended;
}

void Recorder::end_closed() {
  for (std::size_t i = 0; i < channels_.size();) {
    RunChannel& channel = *channels_[i];
    // Read in this order: a run that closed and then dropped its handle is seen as closed, and
    // frames pushed before close() are seen in the ring.
    const bool held = channels_[i].use_count() > 1;
    const bool closed = channel.closed_.load(std::memory_order_acquire);
    const auto take_rest = [&] {
      take_frames(channel);
      return channel.ring_.read_available() == 0;
    };
    const db::RunEnd broken_off{.status = db::RunStatus::Failed,
                                .outcome = "failed",
                                .reason = "The run broke off without a result."};
    if ((!closed && held) || !take_rest() ||
        !end(channel, closed ? channel.end_ : broken_off, closed ? channel.ticks_ : 0)) {
      ++i;
      continue;
    }
    channels_.erase(channels_.begin() + static_cast<std::ptrdiff_t>(i));
  }
  // The store has nothing of these runs, so none is left in it without an end.
  const auto over = [](const auto& channel) {
    return channel->unheard_ && channel->closed_.load(std::memory_order_acquire);
  };
  while (std::ranges::count_if(channels_, over) > static_cast<std::ptrdiff_t>(kMostWaiting)) {
    channels_.erase(std::ranges::find_if(channels_, over));
  }
}

void Recorder::commit() {
  commit_due_ = Clock::now() + options_.commit_interval;
  uncommitted_ = 0;
  if (!ailment_) guarded([&] { store_.commit(); });
}

void Recorder::stop_all() {
  const auto until = Clock::now() + kLastPatience;
  const auto end_all = [&] {
    if (ailment_) ailment_->retry = {};
    recover();
    run_later();
    take_arrivals();
    take_frames();
    end_closed();
    return ailment_ ? ailment_->trouble != db::Trouble::Busy : later_.empty();
  };
  while (!end_all() && Clock::now() < until) std::this_thread::sleep_for(kNap);
  full_.reset();  // no frames come after those still in the rings
  for (const auto& channel : channels_) {
    take_frames(*channel);
    end(*channel,
        {.status = db::RunStatus::Interrupted,
         .outcome = "stopped",
         .reason = "The server was stopped in the middle of this run."},
        0);
    channel->fail("The server was stopped.");
    channel->over_.store(true, std::memory_order_release);
  }
  commit();
  channels_.clear();
}

}  // namespace server
