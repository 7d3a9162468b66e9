// db/run_store.hpp: the only writer of recorded runs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "db/block_codec.hpp"
#include "db/file_lock.hpp"
#include "db/records.hpp"
#include "db/sqlite.hpp"

namespace db {

struct StoreOptions {
  std::uint32_t max_pages = 0;     // largest file size in 4 KiB pages; 0: no limit
  std::uint32_t log_pages = 1000;  // of the write-ahead log before it is folded into the file
  std::shared_ptr<RunNumbers> numbers{};  // null: its own
};

/// Writes runs to one SQLite file (WAL, synchronous FULL).
///
/// Used by one thread at a time. Each file has one RunStore: a second one is refused, also in
/// another program or by another name of the file, because opening interrupts the unfinished runs
/// of the last owner. Readers (RunReader) may come and go in any thread and any program.
///
/// All changes since the last commit() are one transaction. If the database fails (DatabaseError),
/// the transaction is undone. Every run being recorded is then dropped (recording() turns false)
/// and keeps what its last commit stored; resume_run() continues it. A database that is merely Busy
/// has lost nothing. Other StoreErrors refuse one call and change nothing. A closed store answers
/// every call with a DatabaseError.
class RunStore {
 public:
  /// Opens or creates `path`, brings it up to date, and marks every run left queued or recording as
  /// interrupted. Throws StoreError.
  explicit RunStore(const std::string& path, const StoreOptions& options = {});
  struct Closed {};
  /// A closed store, to be opened by open().
  RunStore(const std::string& path, const StoreOptions& options, Closed /*tag*/);
  ~RunStore();
  RunStore(const RunStore&) = delete;
  RunStore& operator=(const RunStore&) = delete;

  const std::string& path() const { return path_; }
  bool is_open() const { return connection_.has_value(); }
  /// Opens the file that is at the path now; reopens an open store. In a file that this store has
  /// not had open before, unfinished runs become interrupted. In the same file they remain its own.
  void open();
  void close() noexcept;
  /// False if the open file has been deleted, renamed or replaced.
  bool in_place() const { return lock_ != nullptr && lock_->still_at(path_); }
  /// Closes the store and renames its files to NAME.WHY-STAMP.db and so on. Returns the new name.
  /// Throws DatabaseError if they cannot be renamed.
  std::string set_aside(std::string_view why, std::string_view stamp);
  /// The error that dropped recordings since the last call, if any.
  std::optional<DatabaseError> take_failure() { return std::exchange(failure_, std::nullopt); }

  /// The unfinished runs that were marked interrupted when the file was opened.
  const std::vector<RunId>& interrupted() const { return interrupted_; }

  /// Creates a run that is recording, with the number `wanted` unless the file already has it.
  RunId begin_run(const NewRun& what, std::optional<RunId> wanted = {});
  /// Creates a run that start_run() starts later.
  RunId queue_run(const NewRun& what, std::optional<RunId> wanted = {});
  /// Starts a queued run. `started`: wall time, ISO 8601.
  void start_run(RunId run, std::string_view started);

  /// Continues a dropped run. Returns the number after its last stored tick, or nothing if the file
  /// has no such unfinished run.
  std::optional<std::uint64_t> resume_run(RunId run);
  /// Queues an ended run again, to be run from its start. Remove its old ticks with clear_run()
  /// before it starts. False if it does not exist or is not interrupted, cancelled or failed.
  bool requeue_run(RunId run);
  /// Removes up to `blocks` blocks of a queued run and commits. True if more remain.
  bool clear_run(RunId run, std::size_t blocks = kSweptBlocks);
  std::optional<RunStatus> status_of(RunId run);

  /// Records why ticks of a run being recorded are missing. Call once per gap.
  void note_gap(RunId run, const Gap& gap);

  /// Appends the frame of one tick. `time`: [s] run clock. Ticks must increase; gaps are allowed.
  /// The first frames of a run grow the buffers; after that only SQLite allocates.
  void append_tick(RunId run,
                   std::uint64_t tick,
                   double time,
                   std::span<const std::byte> frame,
                   std::span<const Window> windows);

  /// Sets the result of a run so far, also while it is recording.
  void set_result(RunId run, const RunVerdict& verdict);
  /// Ends a queued or recording run and writes its last frames. A run that was dropped because the
  /// database failed ends with what its last commit stored. Its lost ticks are at least those of
  /// its gaps by fault.
  void end_run(RunId run, const RunEnd& end);

  /// Begins the transaction of the next change early. Throws DatabaseError; with Busy another
  /// program holds the database and nothing has changed.
  void begin();
  /// Makes all changes so far durable.
  void commit();

  bool recording(RunId run) const { return open_.contains(run); }

  /// Changes what people wrote on a run. False if there is no such run.
  bool remark(RunId run, const RunRemarks& remarks);
  /// Adds and removes tags. False if there is no such run.
  bool change_tags(RunId run,
                   std::span<const std::string> added,
                   std::span<const std::string> removed);
  /// The runs of a batch, oldest first.
  std::vector<RunId> runs_of_batch(RunId batch);

  enum class Deletion : std::uint8_t { Deleted, NotFound, StillRecording };
  /// Removes a run from every list; restore() brings it back until empty_trash(). `now`: [s] since
  /// 1970.
  Deletion trash(RunId run, std::int64_t now);
  /// False if the run is not in the trash any more.
  bool restore(RunId run);
  /// Deletes up to `runs` runs, the oldest first, that came into the trash at `until` [s since
  /// 1970] or before. Returns how many.
  std::size_t empty_trash(std::int64_t until, std::size_t runs);
  /// Removes a run from every list at once; sweep() frees its room block by block.
  Deletion delete_run(RunId run);

  /// Removes up to `blocks` blocks of deleted runs and commits. True if more remain. A run too
  /// damaged to remove stays, and a StoreError names it.
  bool sweep(std::size_t blocks = kSweptBlocks);

  /// Removes up to `blocks` of the oldest blocks of a run being recorded, to make room for newer
  /// ones. All their ticks must be older than `before` [s]; the newest block always stays. Commits.
  /// Returns the number of removed blocks. `sentence` is stored as the cause of the gap.
  std::size_t drop_oldest(RunId run, double before, std::size_t blocks, std::string_view sentence);
  /// [s] run clock of the oldest and the newest tick kept of a run being recorded.
  struct Span {
    double from = 0;
    double to = 0;
  };
  Span span(RunId run) const;

  /// Deletes the oldest ended run if the store is larger than `limit` [bytes]. The file itself does
  /// not shrink: its room is reused. Does nothing while an earlier deletion is not swept yet.
  std::optional<RunRow> retire_oldest(std::uint64_t limit);

  /// [bytes] of the file in use, all runs and indexes together.
  std::uint64_t used_bytes();
  /// [bytes] of the write-ahead log beside it.
  std::uint64_t log_bytes() const;
  /// [bytes] after which it is folded into the file; one large transaction may go beyond it.
  std::uint64_t log_limit() const;
  /// Folds the log into the file and empties it, as far as no reader needs it. Commits.
  void fold_log();
  /// [bytes] of the file freed by deleted runs, for new ones.
  std::uint64_t spare_bytes();

 private:
  static constexpr std::size_t kSweptBlocks = 128;  // about 10,000 ticks

  struct Recording;  // a run with its pending frames
  struct Statements;

  template <typename Action>
  auto guarded(const Action& action);
  template <typename Action>
  auto alone(const Action& action);
  void require_open() const;
  RunId insert(const NewRun& what, RunStatus status, std::optional<RunId> wanted);
  Recording& recording_of(RunId run);
  void write_block(RunId run, Recording& recording);
  void write_progress(RunId run, const Recording& recording);
  void interrupt_unfinished();
  std::optional<std::uint64_t> slice_end(RunId run, std::size_t blocks);
  void delete_before(RunId run, std::uint64_t tick);
  std::optional<RunId> first_deleted();
  /// The rest of a recorded run while its oldest blocks are dropped.
  struct Remains {
    std::uint64_t newest_block = 0;  // its first tick: older blocks may go
    std::uint64_t ticks = 0;
    std::uint64_t bytes = 0;
    double kept_from = 0;  // [s]
  };
  std::optional<std::string> written_tags(RunId run);
  bool drop_block(RunId run, Remains& left, double before, std::string_view sentence);
  std::uint64_t pages(detail::Statement& statement);

  std::string path_;
  StoreOptions options_;
  std::unique_ptr<FileLock> lock_{};  // outlives the connection
  std::optional<detail::Connection> connection_{};
  std::unique_ptr<Statements> sql_;
  std::shared_ptr<detail::Compressor> compressor_ = make_compressor();  // for all recordings
  std::map<RunId, std::unique_ptr<Recording>> open_;
  std::vector<RunId> interrupted_{};
  std::optional<FileIdentity> known_{};  // the file whose unfinished runs belong to this store
  std::optional<DatabaseError> failure_{};
  RunId unsweepable_ = 0;  // deleted runs up to it are not swept
};

}  // namespace db
