// server/record/run_channel.hpp: a control thread's end of the recorder: the ring for its frames.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <boost/lockfree/spsc_queue.hpp>

#include "db/block_codec.hpp"
#include "db/records.hpp"
#include "server/record/record_status.hpp"

namespace server {

/// One tick in the form for the database. The frame pool's frames implement it. bytes() may encode
/// on its first call, so that the control thread never does. Called on the database thread only;
/// other threads may read the same frame meanwhile.
class RecordedFrame {
 public:
  virtual std::span<const std::byte> bytes() const = 0;
  virtual std::span<const db::Window> windows() const = 0;
  virtual std::uint64_t tick() const = 0;
  virtual double time() const = 0;  // [s] run clock
  /// Drops one reference; the last one returns the frame to its pool. Any thread.
  virtual void release() noexcept = 0;

 protected:
  ~RecordedFrame() = default;
};

/// Owns one reference to a frame.
class FrameHandle {
 public:
  FrameHandle() = default;
  /// Takes over the caller's reference.
  explicit FrameHandle(RecordedFrame* frame) noexcept : frame_(frame) {}
  FrameHandle(FrameHandle&& other) noexcept : frame_(other.detach()) {}
  FrameHandle& operator=(FrameHandle&& other) noexcept {
    if (this != &other) {
      reset();
      frame_ = other.detach();
    }
    return *this;
  }
  FrameHandle(const FrameHandle&) = delete;
  FrameHandle& operator=(const FrameHandle&) = delete;
  ~FrameHandle() { reset(); }

  RecordedFrame* get() const noexcept { return frame_; }
  RecordedFrame* operator->() const noexcept { return frame_; }
  explicit operator bool() const noexcept { return frame_ != nullptr; }
  RecordedFrame* detach() noexcept { return std::exchange(frame_, nullptr); }
  void reset() noexcept {
    if (RecordedFrame* frame = detach()) frame->release();
  }

 private:
  RecordedFrame* frame_ = nullptr;
};

namespace detail {

/// Wakes the database thread.
class Doorbell {
 public:
  /// Ends the current or the next sleep.
  void ring();
  /// Ends the current sleep, if any. Costs one atomic load while the database thread is awake, so
  /// the control thread can afford it. It may miss a sleep that is just beginning, which is short.
  void nudge();
  /// Sleeps until a ring or `until`.
  void wait_until(std::chrono::steady_clock::time_point until);

 private:
  std::mutex mutex_{};
  std::condition_variable condition_{};
  std::atomic<bool> asleep_ = false;
  bool rung_ = false;  // guarded by mutex_
};

}  // namespace detail

/// Which part of a run is kept.
enum class Keep : std::uint8_t {
  Whole,       // all ticks, however slow the store: experiments, command-line runs
  NewestHour,  // for live runs, which may last days and never wait for the store
};

/// Only the run's thread may call push(), pause() and close(); any thread the others. Destroying
/// the last handle without close() ends the run as failed.
///
/// A failing store ends no run. Frames are then taken and dropped, and recording resumes by itself
/// when the store works again. The ticks between are a gap in the run's record.
class RunChannel {
 public:
  /// `run`: the run's number, reserved or of an existing row; `what`: enough to write its row
  /// again.
  RunChannel(db::RunId run,
             db::NewRun what,
             Keep keep,
             std::size_t capacity,
             std::shared_ptr<detail::Doorbell> bell);
  ~RunChannel();
  RunChannel(const RunChannel&) = delete;
  RunChannel& operator=(const RunChannel&) = delete;

  /// The run's number. It changes once if a new store file already uses that number.
  db::RunId run() const { return run_.load(std::memory_order_acquire); }
  Keep keep() const { return keep_; }

  /// Hands the frame over and empties `frame`. False, with `frame` unchanged, when the ring is
  /// full. Never blocks on the disk and allocates nothing.
  bool push(FrameHandle& frame);

  /// Pauses the record: ticks until the next push are omitted on purpose.
  void pause();

  /// Ends the run after `ticks` ticks in all. Frames pushed so far are stored first. Call it once.
  void close(db::RunEnd end, std::uint64_t ticks = 0);

  /// True while frames are not recorded; problem() then says why, as a sentence.
  bool failed() const noexcept { return failed_.load(std::memory_order_acquire); }
  std::string problem() const;
  /// problem(), or why ticks of the run are missing for good, as a sentence; empty: none are so
  /// far.
  std::string incomplete() const;
  /// State of this run's record as of the last commit; before the first one, `kind` is Off.
  RecordStatus status() const;

 private:
  friend class Recorder;
  struct Pushed {
    RecordedFrame* frame = nullptr;
    bool after_pause = false;
  };

  void fail(const std::string& why);  // database thread
  void recover();                     // database thread
  void lose(const std::string& why);  // database thread; the first reason stays
  bool tell(RecordStatus status);     // database thread; true if the status changed
  db::Gap gap_until(std::uint64_t tick, bool paused) const;

  std::atomic<db::RunId> run_;
  const db::NewRun what_;
  const Keep keep_;
  const std::size_t half_;
  boost::lockfree::spsc_queue<Pushed> ring_;
  std::shared_ptr<detail::Doorbell> bell_{};

  // The run's thread.
  bool lost_ = false;                // a frame was lost since the last one taken
  std::atomic<bool> paused_{false};  // read by others

  // The database thread.
  std::uint64_t next_tick_ = 0;       // follows the last tick stored
  std::optional<db::Gap> missing_{};  // why later ticks are not stored: cause and sentence
  bool broken_ = false;               // a frame of it could not be stored
  bool unheard_ = false;              // the run began while the store took nothing
  bool dropped_ = false;              // its oldest ticks were dropped for newer ones

  db::RunEnd end_{};  // written before closed_
  std::uint64_t ticks_ = 0;
  std::atomic<bool> closed_ = false;
  mutable std::mutex mutex_{};
  std::string problem_{};  // guarded by mutex_
  std::string loss_{};     // guarded by mutex_
  RecordStatus status_{};  // guarded by mutex_
  std::atomic<bool> failed_ = false;
  std::atomic<bool> over_ = false;  // the ring is no longer emptied
};

}  // namespace server
