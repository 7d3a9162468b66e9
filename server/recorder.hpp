// server/recorder.hpp: the database thread: takes frames from control threads, writes them once a
// second, and does whatever else needs the writing connection.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <boost/lockfree/spsc_queue.hpp>

#include "db/records.hpp"
#include "db/run_store.hpp"

namespace server {

/// One tick as the database needs it. The frame pool implements it; bytes() may encode on its
/// first call, so that the control thread never does. Called on the database thread only, while
/// others may read the same frame.
class RecordedFrame {
 public:
  virtual std::span<const std::byte> bytes() const = 0;
  virtual std::span<const db::Window> windows() const = 0;
  virtual db::TickRow row() const = 0;
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

/// What a job returned or threw, on its way to another thread. A failure travels as its sentence:
/// an exception object shared by two threads is more than this needs.
template <typename Result>
struct Answer {
  using Value = std::conditional_t<std::is_void_v<Result>, std::monostate, Result>;
  std::optional<Value> value{};
  std::string problem{};
  bool of_database = false;

  Result take() {
    if (!value && of_database) throw db::DatabaseError(problem);
    if (!value) throw db::StoreError(problem);
    if constexpr (!std::is_void_v<Result>) return std::move(*value);
  }
};

template <typename Result, typename F>
Answer<Result> answer_of(F& job, db::RunStore& store) {
  Answer<Result> answer{};
  try {
    if constexpr (std::is_void_v<Result>) {
      job(store);
      store.commit();
      answer.value.emplace();
    } else {
      Result result = job(store);
      store.commit();
      answer.value.emplace(std::move(result));
    }
  } catch (const db::DatabaseError& error) {
    answer.problem = error.what();
    answer.of_database = true;
  } catch (const std::exception& error) {
    answer.problem = error.what();
  }
  return answer;
}

}  // namespace detail

/// What a control thread holds of the recorder: the ring its frames go through.
///
/// push() and close() belong to one thread, the run's; failed() and problem() to any. Destroying
/// the last handle without close() ends the run as failed.
class RunChannel {
 public:
  RunChannel(db::RunId run, std::size_t capacity, std::shared_ptr<detail::Doorbell> bell);
  ~RunChannel();
  RunChannel(const RunChannel&) = delete;
  RunChannel& operator=(const RunChannel&) = delete;

  db::RunId run() const { return run_; }

  /// Hands a frame over and empties `frame`; false, with `frame` as it was, when the ring is full:
  /// simulated time then waits, on hardware the tick counts as lost. Never blocks on the disk and
  /// allocates nothing. After failed() frames are taken and dropped.
  bool push(FrameHandle& frame);

  /// The run is over: after the frames pushed so far it is ended so and committed. Once only.
  void close(db::RunEnd end);

  /// True once frames are no longer recorded; problem() then says why, as a sentence.
  bool failed() const noexcept { return failed_.load(std::memory_order_acquire); }
  std::string problem() const { return failed() ? problem_ : std::string{}; }

 private:
  friend class Recorder;
  void fail(const std::string& why);  // database thread, the first time counts

  db::RunId run_ = 0;
  std::size_t half_ = 0;
  boost::lockfree::spsc_queue<RecordedFrame*> ring_;
  std::shared_ptr<detail::Doorbell> bell_{};
  std::uint64_t taken_ = 0;  // frames; the database thread's
  bool full_ = false;        // recorded no further; the database thread's
  db::RunEnd end_{};         // written before closed_
  std::atomic<bool> closed_ = false;
  std::string problem_{};  // written before failed_
  std::atomic<bool> failed_ = false;
};

struct RecorderOptions {
  db::StoreOptions store{};
  std::uint64_t retention_bytes = std::uint64_t{2} << 30;  // 0: keep everything
  /// A little under the second that may be lost, because packing and a slow disk come on top.
  std::chrono::milliseconds commit_interval{900};
  std::size_t ring_frames = 1024;
  /// Told in a sentence what was deleted for room and what went wrong. Database thread.
  std::function<void(const std::string&)> report{};
};

/// Owns the database thread and the writing connection; lives from the server's start to its end.
///
/// Threads: open(), post(), ask() and flush() may be called from any thread but the database
/// thread itself; open(), ask() and flush() wait for it. The control thread's steady state touches
/// its RunChannel only. Jobs and reports run on the database thread.
///
/// All channels share one transaction, committed once per commit_interval, when a run opens or
/// ends, and after a job. When the disk fails, the channels whose frames were lost turn failed();
/// the recorder goes on, and a later open() works again as soon as the disk does.
class Recorder {
 public:
  /// Opens the store, in which unfinished runs become interrupted. Throws db::StoreError.
  explicit Recorder(const std::string& path, RecorderOptions options = {});
  /// Writes what was pushed; runs that are still open end as interrupted.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// The runs found unfinished when the store was opened.
  const std::vector<db::RunId>& interrupted() const { return interrupted_; }

  /// Begins a run and commits it. Throws db::StoreError with the reason, such as a full disk.
  std::shared_ptr<RunChannel> open(const db::NewRun& what);
  /// The same for a queued run; `started`: wall time, ISO 8601.
  std::shared_ptr<RunChannel> open(db::RunId queued, const std::string& started);

  using Job = std::function<void(db::RunStore&)>;
  /// Runs `job` on the database thread and commits. What it throws goes to `report`.
  void post(Job job);

  /// The same, and gives back what `job` returns, after the commit. What it throws comes back as a
  /// db::StoreError (db::DatabaseError stays one) with the same sentence.
  template <typename F>
  auto ask(F job) -> std::invoke_result_t<F&, db::RunStore&> {
    using Result = std::invoke_result_t<F&, db::RunStore&>;
    // The caller waits, so `job` stays; the promise must outlive the call that answers it.
    const auto promise = std::make_shared<std::promise<detail::Answer<Result>>>();
    auto answer = promise->get_future();
    post([promise, &job](db::RunStore& store) {
      promise->set_value(detail::answer_of<Result>(job, store));
    });
    return answer.get().take();
  }

  /// Returns when all that was pushed, closed and posted before is committed.
  void flush();

 private:
  using Clock = std::chrono::steady_clock;

  std::shared_ptr<RunChannel> add_channel(db::RunId run);
  void work();
  void run_jobs();
  void take_frames();
  void take_frames(RunChannel& channel);
  void end_closed();
  void end_lost();
  void commit();
  void make_room();
  void cut_longest();
  void stop_all();
  void drop_lost(const std::string& why);
  void report(const std::string& sentence) const;
  template <typename Action>
  void guarded(const Action& action);

  RecorderOptions options_{};
  std::shared_ptr<detail::Doorbell> bell_ = std::make_shared<detail::Doorbell>();
  db::RunStore store_;  // the database thread's, once it runs
  std::vector<db::RunId> interrupted_{};
  std::vector<std::shared_ptr<RunChannel>> channels_{};   // the database thread's
  std::vector<std::pair<db::RunId, db::RunEnd>> lost_{};  // runs still to be marked as failed
  Clock::time_point commit_due_{};

  std::mutex mutex_{};
  std::vector<Job> jobs_{};  // guarded by mutex_
  bool stopping_ = false;    // guarded by mutex_
  std::thread thread_{};     // last: it uses all of the above
};

}  // namespace server
