// db/run_store.cpp: the only writer of recorded runs.
#include "db/run_store.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "db/run_store_parts.hpp"
#include "db/schema.hpp"

namespace db {

using detail::Connection;
using detail::ResetLater;
using detail::Statement;

namespace {

// A block row ends in its own page, half empty on average. For an hour's 57 MB of blocks, 16 KiB
// pages wasted 6.3 MB and 4 KiB pages 2.3 MB, at the same speed.
constexpr int kPageBytes = 4096;
// A block with this many frames is not rewritten with more at the next commit. Longer blocks pack
// little better (402 bytes a frame at 128 against 414 at 64) and make a seek unpack more.
constexpr std::size_t kSealFrames = 64;
// Limit between two commits of a fast run.
constexpr std::size_t kMaxPendingFrames = 2 * kSealFrames;

Connection open_for_writing(const std::string& path, const StoreOptions& options) {
  Connection connection(path, Connection::Mode::Write);
  // An existing file keeps its page size.
  connection.execute("PRAGMA page_size = " + std::to_string(kPageBytes));
  connection.execute("PRAGMA journal_mode = WAL");
  connection.execute("PRAGMA synchronous = FULL");
  connection.execute("PRAGMA wal_autocheckpoint = " + std::to_string(options.log_pages));
  // A log that grew for a slow reader shrinks again when it restarts.
  connection.execute("PRAGMA journal_size_limit = " +
                     std::to_string(std::uint64_t{options.log_pages} * kPageBytes));
  // [KiB] A writer that appends seldom returns to a page. A larger cache would not help it, and
  // would fill up over the first half hour of a run.
  connection.execute("PRAGMA cache_size = -1024");
  if (options.max_pages > 0) {
    connection.execute("PRAGMA max_page_count = " + std::to_string(options.max_pages));
  }
  detail::set_up(connection);
  return connection;
}

std::string name_of(RunId run) {
  return "run " + std::to_string(run);
}

}  // namespace

RunStore::RunStore(const std::string& path, const StoreOptions& options, Closed /*tag*/)
    : path_(path), options_(options) {
  if (!options_.numbers) options_.numbers = std::make_shared<RunNumbers>();
}

std::uint64_t RunStore::log_limit() const {
  return std::uint64_t{options_.log_pages} * kPageBytes;
}

RunStore::RunStore(const std::string& path, const StoreOptions& options)
    : RunStore(path, options, Closed{}) {
  open();
}

RunStore::~RunStore() {
  close();
}

void RunStore::open() {
  sql_.reset();
  connection_.reset();
  open_.clear();
  // A file that was a run store may be a damaged one now.
  if (!known_ || identity_of(path_) != known_) detail::refuse_other_files(path_);
  // Keeps the lock while the file is the same, so that no other writer can take it in between.
  if (!in_place()) {
    lock_.reset();
    lock_ = std::make_unique<FileLock>(path_);
  }
  try {
    connection_.emplace(open_for_writing(path_, options_));
    sql_ = std::make_unique<Statements>(*connection_);
    options_.numbers->beyond(
        connection_->query_integer("SELECT seq FROM sqlite_sequence WHERE name = 'run'"));
    const auto file = identity_of(path_);
    if (file != known_) interrupt_unfinished();
    known_ = file;
  } catch (...) {
    sql_.reset();
    connection_.reset();
    throw;
  }
}

void RunStore::close() noexcept {
  if (connection_) connection_->roll_back();
  open_.clear();
  sql_.reset();
  connection_.reset();
  lock_.reset();
}

std::string RunStore::set_aside(std::string_view why, std::string_view stamp) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path file = fs::weakly_canonical(path_, error);  // target of a symbolic link
  fs::path aside = file;
  aside.replace_extension('.' + std::string(why) + '-' + std::string(stamp) +
                          file.extension().string());
  // Rename under the lock, and before the connection closes: closing would fold its log in.
  fs::rename(file, aside, error);
  if (error) {
    throw DatabaseError("The run store " + path_ + " could not be set aside (" + error.message() +
                        ").");
  }
  for (const char* beside : {"-wal", "-shm"}) {
    fs::rename(file.string() + beside, aside.string() + beside, error);  // it may not exist
  }
  close();
  known_.reset();
  return aside.string();
}

void RunStore::require_open() const {
  if (!connection_) throw DatabaseError("The run store " + path_ + " is not open just now.");
}

void RunStore::begin() {
  require_open();
  if (!connection_->in_transaction()) sql_->begin.reset().run();
}

void RunStore::interrupt_unfinished() {
  interrupted_.clear();
  guarded([&] {
    begin();
    Statement found = connection_->prepare(
        "UPDATE run SET"
        " reason = iif(status = 'queued', 'The program stopped before this run began.',"
        "              'The program stopped in the middle of this run.'),"
        " status = 'interrupted', outcome = iif(outcome = 'running', 'stopped', outcome),"
        " last_outcome = iif(last_outcome = 'running', 'stopped', last_outcome)"
        " WHERE status IN ('queued', 'recording') RETURNING id");
    while (found.step()) interrupted_.push_back(found.integer(0));
    found.reset();
    sql_->commit.reset().run();
  });
}

std::optional<RunStatus> RunStore::status_of(RunId run) {
  return guarded([&]() -> std::optional<RunStatus> {
    sql_->status.reset() << run;
    const ResetLater reset(sql_->status);
    return sql_->status.step() ? find_status(sql_->status.text(0)) : std::nullopt;
  });
}

RunId RunStore::insert(const NewRun& what, RunStatus status, std::optional<RunId> wanted) {
  begin();
  const auto taken = [&](RunId run) {
    const ResetLater reset(sql_->status.reset());
    sql_->status << run;
    return sql_->status.step();
  };
  RunId run = wanted.value_or(0);
  while (run <= 0 || taken(run)) run = options_.numbers->take();
  sql_->insert_run.reset() << run << to_string(status) << what.scenario << what.controller
                           << what.filter << what.physics << what.seed << what.parameters
                           << what.version << what.started << to_string(what.kind) << what.batch;
  sql_->insert_run.run();
  // The runs of a batch, and resets, have the previous run's document.
  const ResetLater reset(sql_->same_document.reset() << sql_->newest_document << what.document);
  if (sql_->same_document.step()) {
    (sql_->share_document.reset() << sql_->newest_document << run).run();
  } else {
    (sql_->insert_document.reset() << run << what.document).run();
    sql_->newest_document = run;
  }
  return run;
}

RunId RunStore::begin_run(const NewRun& what, std::optional<RunId> wanted) {
  return guarded([&] {
    const RunId run = insert(what, RunStatus::Recording, wanted);
    open_.emplace(run, std::make_unique<Recording>(compressor_));
    return run;
  });
}

RunId RunStore::queue_run(const NewRun& what, std::optional<RunId> wanted) {
  return guarded([&] { return insert(what, RunStatus::Queued, wanted); });
}

std::optional<std::uint64_t> RunStore::resume_run(RunId run) {
  return guarded([&]() -> std::optional<std::uint64_t> {
    begin();
    auto recording = std::make_unique<Recording>(compressor_);
    {
      Statement& found = sql_->resume_run.reset() << run;
      const ResetLater reset(found);
      if (!found.step()) return std::nullopt;
      recording->ticks = found.count(0);
      recording->last_time = found.number(1);
      recording->sealed_bytes = found.count(2);
    }
    std::uint64_t next = 0;
    if (recording->ticks > 0) {
      const ResetLater reset(sql_->newest_tick.reset() << run);
      if (!sql_->newest_tick.step()) return std::nullopt;
      recording->last_tick = sql_->newest_tick.count(0);
      next = recording->last_tick + 1;
      const ResetLater reset_oldest(sql_->oldest_blocks.reset() << run);
      if (sql_->oldest_blocks.step()) recording->kept_from = sql_->oldest_blocks.number(2);
    }
    open_.insert_or_assign(run, std::move(recording));
    return next;
  });
}

void RunStore::note_gap(RunId run, const Gap& gap) {
  guarded([&] {
    begin();
    (sql_->insert_gap.reset() << run << gap.first_tick << gap.last_tick << to_string(gap.cause)
                              << std::string_view(gap.sentence))
        .run();
  });
}

void RunStore::start_run(RunId run, std::string_view started) {
  const bool found = guarded([&] {
    begin();
    sql_->start_run.reset() << started << run;
    const ResetLater reset(sql_->start_run);
    return sql_->start_run.step();
  });
  if (!found) throw StoreError(name_of(run) + " is not waiting to be started");
  open_.emplace(run, std::make_unique<Recording>(compressor_));
}

RunStore::Recording& RunStore::recording_of(RunId run) {
  const auto found = open_.find(run);
  if (found == open_.end()) throw StoreError(name_of(run) + " is not being recorded");
  return *found->second;
}

void RunStore::append_tick(RunId run,
                           std::uint64_t tick,
                           double time,
                           std::span<const std::byte> frame,
                           std::span<const Window> windows) {
  require_open();
  Recording& recording = recording_of(run);
  if (recording.ticks > 0 && tick <= recording.last_tick) {
    throw StoreError(name_of(run) + ": tick " + std::to_string(tick) + " does not follow tick " +
                     std::to_string(recording.last_tick));
  }
  guarded([&] {
    begin();
    // The ticks of a block have no gaps, so that it need not store their numbers.
    const bool gap = recording.ticks > 0 && tick != recording.last_tick + 1;
    const bool full =
        recording.pending.frames() >= kMaxPendingFrames || !recording.pending.fits(frame.size());
    if (recording.pending.frames() > 0 && (gap || full)) {
      write_block(run, recording);
      recording.pending.clear();
    }
    if (recording.pending.frames() == 0) {
      recording.sealed_bytes += std::exchange(recording.block_bytes, 0);
      recording.written_frames = 0;
      recording.first_tick = tick;
      recording.first_time = time;
    }
    try {
      recording.pending.add(frame, windows);
    } catch (const CodecError& error) {
      throw StoreError(name_of(run) + ", tick " + std::to_string(tick) + ": " + error.what());
    }
    if (recording.ticks == 0) recording.kept_from = time;
    recording.last_tick = tick;
    recording.last_time = time;
    ++recording.ticks;
    recording.dirty = true;
  });
}

void RunStore::write_block(RunId run, Recording& recording) {
  if (recording.written_frames == recording.pending.frames()) return;
  const auto packed = recording.pending.encode();
  const std::uint64_t last = recording.first_tick + recording.pending.frames() - 1;
  (sql_->write_block.reset() << run << recording.first_tick << last << recording.first_time
                             << packed)
      .run();
  recording.written_frames = recording.pending.frames();
  recording.block_bytes = packed.size();
}

void RunStore::write_progress(RunId run, const Recording& recording) {
  (sql_->progress.reset() << recording.ticks << recording.last_time
                          << recording.sealed_bytes + recording.block_bytes << run)
      .run();
}

void RunStore::set_result(RunId run, const RunVerdict& verdict) {
  const bool found = guarded([&] {
    begin();
    sql_->set_result.reset() << verdict.outcome << verdict.reason << verdict.metrics
                             << verdict.last_outcome << verdict.last_reason << run;
    const ResetLater reset(sql_->set_result);
    return sql_->set_result.step();
  });
  if (!found) throw StoreError("there is no " + name_of(run));
}

void RunStore::end_run(RunId run, const RunEnd& end) {
  if (end.status == RunStatus::Queued || end.status == RunStatus::Recording) {
    throw StoreError(name_of(run) + " cannot end as " + std::string(to_string(end.status)));
  }
  guarded([&] {
    sql_->status.reset() << run;
    const ResetLater reset(sql_->status);
    const std::string status = sql_->status.step() ? sql_->status.text(0) : "missing";
    if (status != "queued" && status != "recording") {
      throw StoreError(name_of(run) + " cannot be ended: it is " + status);
    }
  });
  guarded([&] {
    begin();
    if (const auto found = open_.find(run); found != open_.end()) {
      Recording& recording = *found->second;
      if (recording.pending.frames() > 0) write_block(run, recording);
      write_progress(run, recording);
      open_.erase(found);
    }
    std::uint64_t lost = end.lost_ticks;
    {
      const ResetLater reset(sql_->lost_ticks.reset() << run);
      if (sql_->lost_ticks.step()) lost = std::max(lost, sql_->lost_ticks.count(0));
    }
    (sql_->end_run.reset() << to_string(end.status) << end.outcome << end.reason << end.metrics
                           << lost << end.last_outcome << end.last_reason << run)
        .run();
  });
}

void RunStore::commit() {
  if (!connection_ || !connection_->in_transaction()) return;
  guarded([&] {
    for (auto& [run, recording] : open_) {
      if (!recording->dirty) continue;
      write_block(run, *recording);
      write_progress(run, *recording);
      recording->dirty = false;
      // A short block grows until it deserves its own row: frames pack better together.
      if (recording->pending.frames() >= kSealFrames) recording->pending.clear();
    }
    sql_->commit.reset().run();
  });
}

}  // namespace db
