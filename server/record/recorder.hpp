// server/record/recorder.hpp: the database thread: takes frames from control threads, commits them
// once a second, and does all other work on the writing connection.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <future>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "db/records.hpp"
#include "db/run_store.hpp"
#include "server/record/disk_space.hpp"
#include "server/record/record_status.hpp"
#include "server/record/run_channel.hpp"

namespace server {

namespace detail {

/// The result or the error of a job, passed to another thread. An error is passed as its sentence,
/// so that two threads need not share an exception object.
template <typename Result>
struct Answer {
  using Value = std::conditional_t<std::is_void_v<Result>, std::monostate, Result>;
  std::optional<Value> value{};
  std::string problem{};
  std::optional<db::Trouble> trouble{};  // set if the database failed

  Result take() {
    if (!value && trouble) throw db::DatabaseError(problem, *trouble);
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
    answer.trouble = error.trouble();
  } catch (const std::exception& error) {
    answer.problem = error.what();
  }
  return answer;
}

}  // namespace detail

struct RecorderOptions {
  db::StoreOptions store{};
  std::uint64_t retention_bytes = std::uint64_t{2} << 30;  // 0: as much as the disk holds
  /// Deletes the oldest finished runs when there is no room. Otherwise finished runs are never
  /// deleted.
  bool evict_oldest = false;
  /// Without room, a run to be kept whole waits until room is made. Otherwise it goes on with a
  /// gap.
  bool wait_for_room = true;
  /// What a person can do about a full record: a sentence that outlives the recorder.
  std::string_view when_full =
      "Finished runs are never deleted unasked, so nothing more is recorded: delete runs, or start "
      "the server with a larger --keep or with --evict oldest.";
  /// How long a deleted run can be restored, if there is room.
  std::chrono::seconds trash_time = std::chrono::minutes(10);
  double live_span = 3600;  // [s] run clock; the span kept of a live run
  double least_span = 60;   // [s] the least span kept of it when there is no room
  /// A little under the one second that may be lost: packing and a slow disk add to it.
  std::chrono::milliseconds commit_interval{900};
  std::chrono::milliseconds retry_interval{1000};  // how often a failed store is tried again
  std::size_t ring_frames = 1024;
  std::function<DiskSpace(const std::string&)> disk = disk_space;
  /// Gets a sentence about each deletion for room and each fault. Called on the database thread.
  std::function<void(const std::string&)> report{};
};

/// Owns the database thread and the writing connection. Lives from the server's start to its end.
///
/// Threads: any thread except the database thread may call any member. open(), ask() and flush()
/// wait for the database thread. In steady state a control thread touches only its RunChannel. Jobs
/// and reports run on the database thread.
///
/// All channels share one transaction. It is committed once per commit_interval, when a run opens
/// or ends, and after a job. While the store is locked, frames wait in their rings. If the store
/// fails, uncommitted data is lost and further frames are dropped. The store is then tried again
/// once per retry_interval, and the runs resume when it works. They resume in a new file if the old
/// one was deleted, or was set aside because it was damaged or from an older program.
class Recorder {
 public:
  /// Opens the store and marks its unfinished runs interrupted. Throws db::StoreError if the file
  /// may not be written or is no run store. Sets aside a store that is damaged or that an older
  /// program wrote, and begins a new one. Opens a store later if it is locked or its disk is full.
  explicit Recorder(const std::string& path, RecorderOptions options = {});
  /// Writes all pushed frames. Runs that are still open end as interrupted.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// The runs found unfinished when the store was opened.
  const std::vector<db::RunId>& interrupted() const { return interrupted_; }

  /// Begins a live run, of which the newest hour is kept. Never waits: the row is written as soon
  /// as the store takes it.
  std::shared_ptr<RunChannel> begin(const db::NewRun& what);
  /// Begins a run to be kept whole, and commits its row. Throws db::StoreError with the reason,
  /// such as a full disk.
  std::shared_ptr<RunChannel> open(const db::NewRun& what);
  /// As above, for a queued run; `what.started` is its start time. Writes a new row if the old one
  /// was lost with a store that was set aside.
  std::shared_ptr<RunChannel> open(db::RunId queued, const db::NewRun& what);

  using Job = std::function<void(db::RunStore&)>;
  /// Runs `job` on the database thread and commits. Errors of `job` go to `report`.
  void post(Job job);
  /// As post(), but retries until the database takes it.
  void post_when_well(Job job);

  /// As post(), but waits for the commit and returns the result of `job`. An error of `job` is
  /// thrown here as a db::StoreError (a db::DatabaseError keeps its type) with the same sentence.
  template <typename F>
  auto ask(F job) -> std::invoke_result_t<F&, db::RunStore&> {
    using Result = std::invoke_result_t<F&, db::RunStore&>;
    // The caller waits, so a reference to `job` is safe. The promise must outlive the call that
    // sets it.
    const auto promise = std::make_shared<std::promise<detail::Answer<Result>>>();
    auto answer = promise->get_future();
    post([promise, &job](db::RunStore& store) {
      promise->set_value(detail::answer_of<Result>(job, store));
    });
    return answer.get().take();
  }

  /// Waits until everything pushed, closed and posted before is committed, or the store has failed.
  /// False if the store is still locked, or without room, after about `patience`.
  bool flush(std::chrono::milliseconds patience = std::chrono::seconds(2));

  /// True if a run that begins now would be recorded.
  bool takes_more() const { return takes_more_.load(); }

  /// State of the newest live run's record, as of the last commit.
  RecordStatus status() const;
  /// Counts changes of status() and of the news. Cheap to poll.
  std::uint64_t revision() const { return revision_.load(); }
  /// Reports since the last call, without the folder of the store.
  std::vector<std::string> take_news();

 private:
  using Clock = std::chrono::steady_clock;
  /// The current fault of the store.
  struct Ailment {
    db::Trouble trouble = db::Trouble::Failed;
    std::string sentence{};
    Clock::time_point since{};
    Clock::time_point retry{};
  };

  void open_store();
  std::shared_ptr<RunChannel> add_channel(db::RunId run, const db::NewRun& what);
  void work();
  void work_once(bool last);
  void run_jobs();
  void run_later();
  void take_arrivals();
  void take_frames(std::size_t most = SIZE_MAX);
  void take_frames(RunChannel& channel, std::size_t most = SIZE_MAX);
  void keep(RunChannel& channel, const RecordedFrame& frame, bool after_pause);
  void note_gap(RunChannel& channel, std::uint64_t tick, bool paused);
  void resume(RunChannel& channel);
  bool last_of_whole(const RunChannel& channel) const;
  bool waits(const RunChannel& channel) const;
  void end_closed();
  bool end(RunChannel& channel, const db::RunEnd& end, std::uint64_t ticks);
  void commit();
  void stop_all();
  template <typename Action>
  void guarded(const Action& action);

  // recorder_health.cpp
  void note_trouble(const db::DatabaseError& error);
  void look_at_file();
  void set_aside(std::string_view why);
  void recover();
  void make_way();
  RecordStatus status_of(const RunChannel* live) const;
  void publish();
  std::string state_sentence(RecordKind kind, const RunChannel* live) const;
  RunChannel* live_channel() const;
  void report(const std::string& sentence);
  std::string without_folder(std::string sentence) const;

  // recorder_room.cpp
  void make_room();
  bool sweep(Clock::time_point until);
  bool empty_trash(std::chrono::system_clock::time_point until);
  bool evict();
  bool drop_live(double span);
  bool must_free(Clock::time_point until);
  void judge_room(bool more_to_come);
  std::int64_t room();

  RecorderOptions options_{};
  /// [bytes] of unpacked frames that make a commit due at once: a fast run must not fill a small
  /// disk between two checks of the room.
  std::uint64_t most_uncommitted_;
  std::shared_ptr<detail::Doorbell> bell_ = std::make_shared<detail::Doorbell>();
  std::shared_ptr<db::RunNumbers> numbers_ = std::make_shared<db::RunNumbers>();
  db::RunStore store_;  // used by the database thread only, once that runs
  std::vector<db::RunId> interrupted_{};

  // Used by the database thread only.
  std::vector<std::shared_ptr<RunChannel>> channels_{};
  std::vector<Job> later_{};  // waiting until the database takes them
  std::optional<Ailment> ailment_{};
  std::optional<std::string> full_{};  // why there is no room, as a sentence
  std::string evicted_{};              // what was deleted for room, as a sentence
  std::string room_problem_{};         // why no room could be made; the last report of it
  std::uint64_t evicted_runs_ = 0;
  std::uint64_t used_ = 0;                                             // [bytes] at the last commit
  std::int64_t room_left_ = std::numeric_limits<std::int64_t>::min();  // [bytes] at the last check
  std::uint64_t uncommitted_ = 0;  // [bytes] of unpacked frames since the last commit
  Clock::time_point commit_due_{};
  Clock::time_point round_due_{};  // a commit, then a look at the room
  Clock::time_point set_aside_{};

  std::atomic<bool> takes_more_{false};
  std::atomic<std::uint64_t> revision_{0};
  mutable std::mutex mutex_{};
  std::vector<Job> jobs_{};                              // guarded by mutex_
  std::vector<std::shared_ptr<RunChannel>> arrivals_{};  // guarded by mutex_
  bool stopping_ = false;                                // guarded by mutex_
  RecordStatus status_{};                                // guarded by mutex_
  std::vector<std::string> news_{};                      // guarded by mutex_
  std::thread thread_{};                                 // last: it uses all of the above
};

}  // namespace server
