// db/run_store.cpp: the one writer of recorded runs.
#include "db/run_store.hpp"

#include <cerrno>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "db/schema.hpp"

namespace db {

using detail::Connection;
using detail::ResetLater;
using detail::Statement;

namespace {

// A block row ends in a page of its own, half empty on average: of an hour's 57 MB of blocks 16 KiB
// pages wasted 6.3 MB, 4 KiB pages 2.3 MB, at the same speed.
constexpr int kPageBytes = 4096;
// A block with so many frames is not rewritten with more at the next commit. Longer blocks pack
// little better (402 bytes a frame at 128 against 414 at 64) and cost a seek more to unpack.
constexpr std::size_t kSealFrames = 64;
// Between two commits of a fast run.
constexpr std::size_t kMaxPendingFrames = 2 * kSealFrames;

Connection open_for_writing(const std::string& path, const StoreOptions& options) {
  Connection connection(path, Connection::Mode::Write);
  // Of an existing file the page size stays as it is.
  connection.execute("PRAGMA page_size = " + std::to_string(kPageBytes));
  connection.execute("PRAGMA journal_mode = WAL");
  connection.execute("PRAGMA synchronous = FULL");
  // [KiB] A writer that appends seldom comes back to a page: a larger cache would not help it, and
  // fill up over the first half hour of a run.
  connection.execute("PRAGMA cache_size = -1024");
  if (options.max_pages > 0) {
    connection.execute("PRAGMA max_page_count = " + std::to_string(options.max_pages));
  }
  detail::migrate(connection);
  return connection;
}

std::string name_of(RunId run) {
  return "run " + std::to_string(run);
}

}  // namespace

/// Held for as long as the store is open; the system gives it back when the program dies.
struct RunStore::FileLock {
  explicit FileLock(const std::string& path)
      : descriptor(::open((path + ".lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644)) {
    if (descriptor < 0) {
      throw DatabaseError("Cannot open the run store " + path +
                          ": its folder is missing or may not be written.");
    }
    if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
      const bool held = errno == EWOULDBLOCK;
      ::close(descriptor);
      throw DatabaseError(held ? "The run store " + path +
                                     " is being written by another server; stop it or choose "
                                     "another file."
                               : "The run store " + path + " cannot be locked.");
    }
  }
  ~FileLock() { ::close(descriptor); }
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

  int descriptor = -1;
};

struct RunStore::Recording {
  BlockEncoder pending{};          // frames of the newest block, which may still grow
  std::uint64_t first_tick = 0;    // of that block
  std::size_t written_frames = 0;  // of pending, those already in the block row
  std::uint64_t sealed_bytes = 0;  // of the blocks before it
  std::uint64_t block_bytes = 0;   // of that block's row
  std::uint64_t ticks = 0;
  TickRow last{};
  bool dirty = false;  // the run row does not show the newest tick
};

struct RunStore::Statements {
  explicit Statements(const Connection& c)
      : begin(c.prepare("BEGIN IMMEDIATE")),
        commit(c.prepare("COMMIT")),
        insert_run(c.prepare(
            "INSERT INTO run (status, scenario, controller, filter, vehicle, seed, parameters,"
            " version, started) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)")),
        insert_document(c.prepare("INSERT INTO document (run, text) VALUES (?, ?)")),
        start_run(c.prepare(
            "UPDATE run SET status = 'recording', started = ? WHERE id = ? AND status = 'queued'"
            " RETURNING id")),
        insert_tick(c.prepare("INSERT INTO tick VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")),
        write_block(
            c.prepare("INSERT INTO block (run, first_tick, last_tick, frames) VALUES (?, ?, ?, ?)"
                      " ON CONFLICT (run, first_tick) DO UPDATE"
                      " SET last_tick = excluded.last_tick, frames = excluded.frames")),
        progress(c.prepare("UPDATE run SET ticks = ?, time = ?, bytes = ? WHERE id = ?")),
        set_result(c.prepare("UPDATE run SET outcome = ?, reason = ?, metrics = ? WHERE id = ?"
                             " AND status <> 'deleted' RETURNING id")),
        end_run(c.prepare(
            "UPDATE run SET status = ?, outcome = ?, reason = ?, metrics = ?, lost_ticks = ?"
            " WHERE id = ?")),
        status(c.prepare("SELECT status FROM run WHERE id = ?")),
        mark_deleted(c.prepare("UPDATE run SET status = 'deleted' WHERE id = ?")),
        oldest_ended(c.prepare(
            "SELECT id, status, scenario, started, ticks, bytes FROM run"
            " WHERE status NOT IN ('queued', 'recording', 'deleted') ORDER BY id LIMIT 1")),
        deleted(c.prepare("SELECT id FROM run WHERE status = 'deleted' ORDER BY id LIMIT 1")),
        slice_end(c.prepare("SELECT tick FROM tick WHERE run = ? ORDER BY tick LIMIT 1 OFFSET ?")),
        delete_ticks(c.prepare("DELETE FROM tick WHERE run = ? AND tick < ?")),
        delete_blocks(c.prepare("DELETE FROM block WHERE run = ? AND first_tick < ?")),
        delete_document(c.prepare("DELETE FROM document WHERE run = ?")),
        delete_run(c.prepare("DELETE FROM run WHERE id = ?")),
        page_count(c.prepare("PRAGMA page_count")),
        free_pages(c.prepare("PRAGMA freelist_count")),
        page_bytes(c.query_integer("PRAGMA page_size")) {}

  Statement begin, commit, insert_run, insert_document, start_run, insert_tick, write_block;
  Statement progress, set_result, end_run, status, mark_deleted, oldest_ended, deleted, slice_end;
  Statement delete_ticks, delete_blocks, delete_document, delete_run, page_count, free_pages;
  std::int64_t page_bytes = 0;
};

RunStore::RunStore(const std::string& path, const StoreOptions& options)
    : lock_(std::make_unique<FileLock>(path)), connection_(open_for_writing(path, options)) {
  sql_ = std::make_unique<Statements>(connection_);
  interrupt_unfinished();
}

RunStore::~RunStore() {
  connection_.roll_back();
}

/// Runs `action`; when the database fails under it, nothing since the last commit remains.
template <typename Action>
auto RunStore::guarded(const Action& action) {
  try {
    return action();
  } catch (const DatabaseError&) {
    connection_.roll_back();
    open_.clear();
    throw;
  }
}

void RunStore::begin() {
  if (!connection_.in_transaction()) sql_->begin.reset().run();
}

void RunStore::interrupt_unfinished() {
  guarded([&] {
    begin();
    Statement found = connection_.prepare(
        "UPDATE run SET"
        " reason = iif(status = 'queued', 'The program stopped before this run began.',"
        "              'The program stopped in the middle of this run.'),"
        " status = 'interrupted', outcome = iif(outcome = 'running', 'stopped', outcome),"
        " ticks = (SELECT count(*) FROM tick WHERE run = run.id),"
        " time = coalesce((SELECT t FROM tick WHERE run = run.id ORDER BY tick DESC LIMIT 1), 0),"
        " bytes = coalesce((SELECT sum(length(frames)) FROM block WHERE run = run.id), 0)"
        " WHERE status IN ('queued', 'recording') RETURNING id");
    while (found.step()) interrupted_.push_back(found.integer(0));
    found.reset();
    sql_->commit.reset().run();
  });
}

RunId RunStore::insert(const NewRun& what, RunStatus status) {
  begin();
  sql_->insert_run.reset() << to_string(status) << what.scenario << what.controller << what.filter
                           << what.vehicle << static_cast<std::int64_t>(what.seed)
                           << what.parameters << what.version << what.started;
  sql_->insert_run.run();
  const RunId run = connection_.last_insert_id();
  (sql_->insert_document.reset() << run << what.document).run();
  return run;
}

RunId RunStore::begin_run(const NewRun& what) {
  return guarded([&] {
    const RunId run = insert(what, RunStatus::Recording);
    open_.emplace(run, std::make_unique<Recording>());
    return run;
  });
}

RunId RunStore::queue_run(const NewRun& what) {
  return guarded([&] { return insert(what, RunStatus::Queued); });
}

void RunStore::start_run(RunId run, std::string_view started) {
  const bool found = guarded([&] {
    begin();
    sql_->start_run.reset() << started << run;
    const ResetLater reset(sql_->start_run);
    return sql_->start_run.step();
  });
  if (!found) throw StoreError(name_of(run) + " is not waiting to be started");
  open_.emplace(run, std::make_unique<Recording>());
}

RunStore::Recording& RunStore::recording_of(RunId run) {
  const auto found = open_.find(run);
  if (found == open_.end()) throw StoreError(name_of(run) + " is not being recorded");
  return *found->second;
}

void RunStore::append_tick(RunId run,
                           const TickRow& row,
                           std::span<const std::byte> frame,
                           std::span<const Window> windows) {
  Recording& recording = recording_of(run);
  if (recording.ticks > 0 && row.tick <= recording.last.tick) {
    throw StoreError(name_of(run) + ": tick " + std::to_string(row.tick) +
                     " does not follow tick " + std::to_string(recording.last.tick));
  }
  guarded([&] {
    begin();
    // Ticks of a block follow each other without a gap, so that it need not store their numbers.
    const bool gap = recording.ticks > 0 && row.tick != recording.last.tick + 1;
    const bool full =
        recording.pending.frames() >= kMaxPendingFrames || !recording.pending.fits(frame.size());
    if (recording.pending.frames() > 0 && (gap || full)) {
      write_block(run, recording);
      recording.pending.clear();
    }
    if (recording.pending.frames() == 0) {
      recording.sealed_bytes += std::exchange(recording.block_bytes, 0);
      recording.written_frames = 0;
      recording.first_tick = row.tick;
    }
    try {
      recording.pending.add(frame, windows);
    } catch (const CodecError& error) {
      throw StoreError(name_of(run) + ", tick " + std::to_string(row.tick) + ": " + error.what());
    }
    Statement& insert = sql_->insert_tick.reset();
    insert << run << static_cast<std::int64_t>(row.tick) << row.t << row.x << row.y << row.heading
           << row.v << row.omega << row.clearance << std::int64_t{row.hold}
           << std::int64_t{row.behaviour};
    insert.run();
    recording.last = row;
    ++recording.ticks;
    recording.dirty = true;
  });
}

void RunStore::write_block(RunId run, Recording& recording) {
  if (recording.written_frames == recording.pending.frames()) return;
  const auto packed = recording.pending.encode();
  const std::uint64_t last = recording.first_tick + recording.pending.frames() - 1;
  (sql_->write_block.reset() << run << static_cast<std::int64_t>(recording.first_tick)
                             << static_cast<std::int64_t>(last) << packed)
      .run();
  recording.written_frames = recording.pending.frames();
  recording.block_bytes = packed.size();
}

void RunStore::set_result(RunId run,
                          std::string_view outcome,
                          std::string_view reason,
                          std::string_view metrics) {
  const bool found = guarded([&] {
    begin();
    sql_->set_result.reset() << outcome << reason << metrics << run;
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
      (sql_->progress.reset() << static_cast<std::int64_t>(recording.ticks) << recording.last.t
                              << static_cast<std::int64_t>(recording.sealed_bytes +
                                                           recording.block_bytes)
                              << run)
          .run();
      open_.erase(found);
    }
    (sql_->end_run.reset() << to_string(end.status) << end.outcome << end.reason << end.metrics
                           << static_cast<std::int64_t>(end.lost_ticks) << run)
        .run();
  });
}

void RunStore::commit() {
  if (!connection_.in_transaction()) return;
  guarded([&] {
    for (auto& [run, recording] : open_) {
      if (!recording->dirty) continue;
      write_block(run, *recording);
      (sql_->progress.reset() << static_cast<std::int64_t>(recording->ticks) << recording->last.t
                              << static_cast<std::int64_t>(recording->sealed_bytes +
                                                           recording->block_bytes)
                              << run)
          .run();
      recording->dirty = false;
      // A short block grows until it is worth its own row: frames pack better together.
      if (recording->pending.frames() >= kSealFrames) recording->pending.clear();
    }
    sql_->commit.reset().run();
  });
}

RunStore::Deletion RunStore::delete_run(RunId run) {
  return guarded([&] {
    begin();
    sql_->status.reset() << run;
    const ResetLater reset(sql_->status);
    if (!sql_->status.step()) return Deletion::NotFound;
    const std::string status = sql_->status.text(0);
    if (status == "deleted") return Deletion::NotFound;
    if (status == "recording" || status == "queued") return Deletion::StillRecording;
    (sql_->mark_deleted.reset() << run).run();
    return Deletion::Deleted;
  });
}

bool RunStore::sweep(std::size_t ticks) {
  return guarded([&] {
    std::int64_t run = 0;
    {
      const ResetLater reset(sql_->deleted.reset());
      if (!sql_->deleted.step()) return false;
      run = sql_->deleted.integer(0);
    }
    begin();
    sql_->slice_end.reset() << run << static_cast<std::int64_t>(ticks);
    const bool more = sql_->slice_end.step();
    const std::int64_t end = more ? sql_->slice_end.integer(0) : INT64_MAX;
    sql_->slice_end.reset();
    (sql_->delete_ticks.reset() << run << end).run();
    (sql_->delete_blocks.reset() << run << end).run();
    if (!more) {
      (sql_->delete_document.reset() << run).run();
      (sql_->delete_run.reset() << run).run();
    }
    commit();
    const ResetLater reset(sql_->deleted.reset());
    return sql_->deleted.step();
  });
}

std::optional<RunRow> RunStore::retire_oldest(std::uint64_t limit) {
  return guarded([&]() -> std::optional<RunRow> {
    if (used_bytes() <= limit) return std::nullopt;
    {
      const ResetLater reset(sql_->deleted.reset());
      if (sql_->deleted.step()) return std::nullopt;
    }
    RunRow oldest{};
    {
      Statement& found = sql_->oldest_ended.reset();
      const ResetLater reset(found);
      if (!found.step()) return std::nullopt;
      oldest.id = found.integer(0);
      oldest.status = find_status(found.text(1)).value_or(RunStatus::Finished);
      oldest.what.scenario = found.text(2);
      oldest.what.started = found.text(3);
      oldest.ticks = static_cast<std::uint64_t>(found.integer(4));
      oldest.bytes = static_cast<std::uint64_t>(found.integer(5));
    }
    begin();
    (sql_->mark_deleted.reset() << oldest.id).run();
    commit();
    return oldest;
  });
}

std::uint64_t RunStore::used_bytes() {
  return guarded([&] {
    const auto value = [](Statement& statement) {
      const ResetLater reset(statement.reset());
      return statement.step() ? statement.integer(0) : std::int64_t{0};
    };
    const std::int64_t pages = value(sql_->page_count) - value(sql_->free_pages);
    return static_cast<std::uint64_t>(pages * sql_->page_bytes);
  });
}

}  // namespace db
