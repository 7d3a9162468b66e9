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
#include <vector>

#include "db/block_codec.hpp"
#include "db/records.hpp"
#include "db/sqlite.hpp"

namespace db {

struct StoreOptions {
  std::uint32_t max_pages = 0;  // the file may not grow beyond so many 4 KiB pages; 0: no limit
};

/// Writes runs into one SQLite file (WAL, synchronous FULL).
///
/// One thread at a time owns it. One RunStore per file: a second one, also in another program, is
/// refused by a lock file beside it, because opening ends what the last owner left unfinished.
/// Readers (RunReader) may come and go in any thread and any program.
///
/// Everything since the last commit() is one transaction. When the database fails (DatabaseError)
/// the transaction is undone, every run being recorded is dropped (recording() turns false) and
/// keeps what its last commit stored; the store itself stays usable. Other StoreErrors refuse one
/// call and change nothing.
class RunStore {
 public:
  /// Opens or makes `path`, brings it up to date, and marks every run left queued or recording as
  /// interrupted. Throws StoreError.
  explicit RunStore(const std::string& path, const StoreOptions& options = {});
  ~RunStore();
  RunStore(const RunStore&) = delete;
  RunStore& operator=(const RunStore&) = delete;

  /// The runs found unfinished and marked interrupted by the constructor.
  const std::vector<RunId>& interrupted() const { return interrupted_; }

  /// A new run that is recording from now on.
  RunId begin_run(const NewRun& what);
  /// A new run that start_run() sets going later.
  RunId queue_run(const NewRun& what);
  /// Sets a queued run going. `started`: wall time, ISO 8601.
  void start_run(RunId run, std::string_view started);

  /// Appends one tick with its frame. Ticks grow; a gap is allowed. The first frames of a run
  /// grow the buffers, after that nothing is allocated here but by SQLite.
  void append_tick(RunId run,
                   const TickRow& row,
                   std::span<const std::byte> frame,
                   std::span<const Window> windows);

  /// What is known of a run so far, also while it is recording. `metrics`: JSON text.
  void set_result(RunId run,
                  std::string_view outcome,
                  std::string_view reason,
                  std::string_view metrics);
  /// Ends a queued or recording run; its last frames are written. A run that was dropped because
  /// the database failed ends with what its last commit stored.
  void end_run(RunId run, const RunEnd& end);

  /// Makes everything so far durable.
  void commit();

  bool recording(RunId run) const { return open_.contains(run); }

  enum class Deletion : std::uint8_t { Deleted, NotFound, StillRecording };
  /// Takes a run out of every list at once; sweep() gives its room back piece by piece.
  Deletion delete_run(RunId run);

  /// Removes the data of up to `ticks` ticks of deleted runs and commits. True while there is more.
  bool sweep(std::size_t ticks = 10'000);

  /// Deletes the oldest ended run when the store is larger than `limit` [bytes]. The file itself
  /// does not shrink: its room is used again. Nothing while an earlier deletion is not swept yet.
  std::optional<RunRow> retire_oldest(std::uint64_t limit);

  /// [bytes] of the file in use, all runs and indexes together.
  std::uint64_t used_bytes();

 private:
  struct Recording;  // a run with its pending frames
  struct Statements;

  template <typename Action>
  auto guarded(const Action& action);
  void begin();
  RunId insert(const NewRun& what, RunStatus status);
  Recording& recording_of(RunId run);
  void write_block(RunId run, Recording& recording);
  void interrupt_unfinished();

  struct FileLock;
  std::unique_ptr<FileLock> lock_;
  detail::Connection connection_;
  std::unique_ptr<Statements> sql_;
  std::map<RunId, std::unique_ptr<Recording>> open_;
  std::vector<RunId> interrupted_{};
};

}  // namespace db
