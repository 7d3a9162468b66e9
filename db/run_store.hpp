// db/run_store.hpp: the one writer of recorded runs.
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
  std::uint32_t max_pages = 0;     // the file may not grow beyond so many 4 KiB pages; 0: no limit
  std::uint32_t log_pages = 1000;  // of the write-ahead log, before it is folded into the file
  std::shared_ptr<RunNumbers> numbers{};  // null: the store's own
};

/// Writes runs into one SQLite file (WAL, synchronous FULL).
///
/// One thread at a time owns it. One RunStore per file: a second one, also in another program or by
/// another name of the file, is refused, because opening ends what the last owner left unfinished.
/// Readers (RunReader) may come and go in any thread and any program.
///
/// Everything since the last commit() is one transaction. When the database fails (DatabaseError)
/// the transaction is undone, every run being recorded is dropped (recording() turns false) and
/// keeps what its last commit stored; resume_run() goes on with it. A database that is merely Busy
/// has lost nothing. Other StoreErrors refuse one call and change nothing. A store that is closed
/// answers every call with a DatabaseError.
class RunStore {
 public:
  /// Opens or makes `path`, brings it up to date, and marks every run left queued or recording as
  /// interrupted. Throws StoreError.
  explicit RunStore(const std::string& path, const StoreOptions& options = {});
  struct Closed {};
  /// One that open() opens.
  RunStore(const std::string& path, const StoreOptions& options, Closed /*tag*/);
  ~RunStore();
  RunStore(const RunStore&) = delete;
  RunStore& operator=(const RunStore&) = delete;

  const std::string& path() const { return path_; }
  bool is_open() const { return connection_.has_value(); }
  /// Opens what lies at the path now, anew when it is open. Unfinished runs become interrupted in a
  /// file this store had not open before; in the same file they are still its own.
  void open();
  void close() noexcept;
  /// False when the open file was deleted, renamed or replaced.
  bool in_place() const { return lock_ != nullptr && lock_->still_at(path_); }
  /// Closes the store and renames its files to NAME.WHY-STAMP.db and so on. Returns the new
  /// name. Throws DatabaseError when they cannot be renamed.
  std::string set_aside(std::string_view why, std::string_view stamp);
  /// The error by which recordings were dropped since the last call, if any.
  std::optional<DatabaseError> take_failure() { return std::exchange(failure_, std::nullopt); }

  /// The runs found unfinished and marked interrupted when the file was opened.
  const std::vector<RunId>& interrupted() const { return interrupted_; }

  /// A new run that is recording from now on; with the number `wanted` unless the file has one so.
  RunId begin_run(const NewRun& what, std::optional<RunId> wanted = {});
  /// A new run that start_run() sets going later.
  RunId queue_run(const NewRun& what, std::optional<RunId> wanted = {});
  /// Sets a queued run going. `started`: wall time, ISO 8601.
  void start_run(RunId run, std::string_view started);

  /// Goes on with a run that was dropped. Returns the number after its last stored tick, or nothing
  /// when the file has no such run unfinished.
  std::optional<std::uint64_t> resume_run(RunId run);
  /// Puts an ended run back among the queued ones, to be run again from its start; clear_run()
  /// takes its old ticks away first. False when it is not there or not interrupted, cancelled or
  /// failed.
  bool requeue_run(RunId run);
  /// Removes up to `blocks` blocks of a queued run and commits. True while there are more.
  bool clear_run(RunId run, std::size_t blocks = kSweptBlocks);
  std::optional<RunStatus> status_of(RunId run);

  /// Says why ticks of a run being recorded are missing. One stretch once.
  void note_gap(RunId run, const Gap& gap);

  /// Appends the frame of one tick. `time`: [s] run clock. Ticks grow; a gap is allowed. The first
  /// frames of a run grow the buffers, after that nothing is allocated here but by SQLite.
  void append_tick(RunId run,
                   std::uint64_t tick,
                   double time,
                   std::span<const std::byte> frame,
                   std::span<const Window> windows);

  /// What is known of a run so far, also while it is recording. `metrics`: JSON text.
  void set_result(RunId run,
                  std::string_view outcome,
                  std::string_view reason,
                  std::string_view metrics);
  /// Ends a queued or recording run; its last frames are written. A run that was dropped because
  /// the database failed ends with what its last commit stored. Its lost ticks are at least those
  /// of its gaps by fault.
  void end_run(RunId run, const RunEnd& end);

  /// Begins the transaction that the next change would begin. Throws DatabaseError, with Busy when
  /// another program holds the database; then nothing has happened.
  void begin();
  /// Makes everything so far durable.
  void commit();

  bool recording(RunId run) const { return open_.contains(run); }

  enum class Deletion : std::uint8_t { Deleted, NotFound, StillRecording };
  /// Takes a run out of every list at once; sweep() gives its room back piece by piece.
  Deletion delete_run(RunId run);

  /// Removes up to `blocks` blocks of deleted runs and commits. True while there is more.
  /// A run that is too damaged for it is left as it is, with a StoreError that names it.
  bool sweep(std::size_t blocks = kSweptBlocks);

  /// Gives up to `blocks` of the oldest blocks of a run being recorded up for newer ones, as far as
  /// all their ticks are older than `before` [s]; the newest block stays. Commits. Returns how many
  /// went. `sentence` is kept as the cause of the gap.
  std::size_t drop_oldest(RunId run, double before, std::size_t blocks, std::string_view sentence);
  /// [s] run clock of the oldest and the newest tick kept of a run being recorded.
  struct Span {
    double from = 0;
    double to = 0;
  };
  Span span(RunId run) const;

  /// Deletes the oldest ended run when the store is larger than `limit` [bytes]. The file itself
  /// does not shrink: its room is used again. Nothing while an earlier deletion is not swept yet.
  std::optional<RunRow> retire_oldest(std::uint64_t limit);

  /// [bytes] of the file in use, all runs and indexes together.
  std::uint64_t used_bytes();
  /// [bytes] of the write-ahead log beside it.
  std::uint64_t log_bytes() const;
  /// [bytes] after which it is folded into the file; one large transaction may go beyond it.
  std::uint64_t log_limit() const;
  /// Folds the log into the file and empties it, as far as no reader needs it. Commits.
  void fold_log();
  /// [bytes] of the file that deleted runs left and new ones will fill.
  std::uint64_t spare_bytes();

 private:
  static constexpr std::size_t kSweptBlocks = 128;  // some 10,000 ticks

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
  /// What is left of a recorded run while its oldest blocks go.
  struct Remains {
    std::uint64_t newest_block = 0;  // its first tick: what ends before it may go
    std::uint64_t ticks = 0;
    std::uint64_t bytes = 0;
    double kept_from = 0;  // [s]
  };
  bool drop_block(RunId run, Remains& left, double before, std::string_view sentence);
  std::uint64_t pages(detail::Statement& statement);

  std::string path_;
  StoreOptions options_;
  std::unique_ptr<FileLock> lock_{};  // outlives the connection
  std::optional<detail::Connection> connection_{};
  std::unique_ptr<Statements> sql_;
  std::shared_ptr<detail::Compressor> compressor_ = make_compressor();  // of all recordings
  std::map<RunId, std::unique_ptr<Recording>> open_;
  std::vector<RunId> interrupted_{};
  std::optional<FileIdentity> known_{};  // the file whose unfinished runs are this store's own
  std::optional<DatabaseError> failure_{};
  RunId unsweepable_ = 0;  // deleted runs up to it are left as they are
};

}  // namespace db
