// server/record/run_channel.hpp: what a control thread holds of the recorder: the ring its frames
// go through.
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

/// One tick as the database needs it. The frame pool implements it; bytes() may encode on its
/// first call, so that the control thread never does. Called on the database thread only, while
/// others may read the same frame.
class RecordedFrame {
 public:
  virtual std::span<const std::byte> bytes() const = 0;
  virtual std::span<const db::Window> windows() const = 0;
  virtual std::uint64_t tick() const = 0;
  virtual double time() const = 0;  // [s] run clock
  /// Gives up one reference; the last one returns the frame to its pool. Any thread.
  virtual void release() noexcept = 0;

 protected:
  ~RecordedFrame() = default;
};

/// Owns one reference to a frame.
class FrameHandle {
 public:
  FrameHandle() = default;
  /// Takes over a reference the caller holds.
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
  /// Ends the present or the next sleep.
  void ring();
  /// Ends the present sleep, if any: one atomic load while the other is awake, so the control
  /// thread can afford it. A sleep that just begins may be missed; it is short.
  void nudge();
  /// Sleeps until rung or `until`.
  void wait_until(std::chrono::steady_clock::time_point until);

 private:
  std::mutex mutex_{};
  std::condition_variable condition_{};
  std::atomic<bool> asleep_ = false;
  bool rung_ = false;  // guarded by mutex_
};

}  // namespace detail

/// How much of a run is kept.
enum class Keep : std::uint8_t {
  Whole,       // all of it, however long the store takes: experiments, runs of the command line
  NewestHour,  // of a live run, which may go on for days; it never waits for the store
};

/// push(), pause() and close() belong to one thread, the run's; the others to any. Destroying the
/// last handle without close() ends the run as failed.
///
/// A store that fails ends no run: its frames are then taken and dropped, and recording goes on by
/// itself when the store is well. The ticks between are a gap in the run's record.
class RunChannel {
 public:
  /// `run`: its number, reserved or of a row that is there; `what`: enough to begin it anew.
  RunChannel(db::RunId run,
             db::NewRun what,
             Keep keep,
             std::size_t capacity,
             std::shared_ptr<detail::Doorbell> bell);
  ~RunChannel();
  RunChannel(const RunChannel&) = delete;
  RunChannel& operator=(const RunChannel&) = delete;

  /// The run's number. It changes once when another file took the store's place and has one so.
  db::RunId run() const { return run_.load(std::memory_order_acquire); }
  Keep keep() const { return keep_; }

  /// Hands a frame over and empties `frame`; false, with `frame` as it was, when the ring is full.
  /// Never blocks on the disk and allocates nothing.
  bool push(FrameHandle& frame);

  /// Nothing happens: the ticks until the next push are left out on purpose.
  void pause();

  /// The run is over, after `ticks` ticks in all; what was pushed so far comes first. Once only.
  void close(db::RunEnd end, std::uint64_t ticks = 0);

  /// True while frames are not recorded; problem() then says why, as a sentence.
  bool failed() const noexcept { return failed_.load(std::memory_order_acquire); }
  std::string problem() const;
  /// How the record of this run is doing, as of the last commit; before it `kind` is Off.
  RecordStatus status() const;

 private:
  friend class Recorder;
  struct Pushed {
    RecordedFrame* frame = nullptr;
    bool after_pause = false;
  };

  void fail(const std::string& why);  // database thread
  void recover();                     // database thread
  bool tell(RecordStatus status);     // database thread; true when it is another
  db::Gap gap_until(std::uint64_t tick, bool paused) const;

  std::atomic<db::RunId> run_;
  const db::NewRun what_;
  const Keep keep_;
  const std::size_t half_;
  boost::lockfree::spsc_queue<Pushed> ring_;
  std::shared_ptr<detail::Doorbell> bell_{};

  // The run's thread.
  bool lost_ = false;                // a frame, since the last one that was taken
  std::atomic<bool> paused_{false};  // read by others

  // The database thread.
  std::uint64_t next_tick_ = 0;       // after the last one stored
  std::optional<db::Gap> missing_{};  // why the ticks since then are not: cause and sentence
  bool broken_ = false;               // a frame of it could not be stored
  bool unheard_ = false;              // it began while the store took nothing
  bool dropped_ = false;              // its oldest ticks went for newer ones

  db::RunEnd end_{};  // written before closed_
  std::uint64_t ticks_ = 0;
  std::atomic<bool> closed_ = false;
  mutable std::mutex mutex_{};
  std::string problem_{};  // guarded by mutex_
  RecordStatus status_{};  // guarded by mutex_
  std::atomic<bool> failed_ = false;
  std::atomic<bool> over_ = false;  // nobody empties the ring any more
};

}  // namespace server
