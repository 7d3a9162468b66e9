// db/run_store_room.cpp: frees room (deletions, the oldest ticks of live runs) and measures it.
#include <algorithm>
#include <filesystem>
#include <limits>
#include <system_error>

#include "db/run_store_parts.hpp"

namespace db {

using detail::ResetLater;
using detail::Statement;

namespace {
constexpr std::uint64_t kEveryTick = std::numeric_limits<std::int64_t>::max();
}

RunStore::Deletion RunStore::delete_run(RunId run) {
  return guarded([&] {
    begin();
    const bool at_work = open_.contains(run);
    sql_->status.reset() << run;
    const ResetLater reset(sql_->status);
    if (!sql_->status.step()) return Deletion::NotFound;
    const std::string status = sql_->status.text(0);
    if (status == "deleted") return Deletion::NotFound;
    if (at_work || status == "recording" || status == "queued") return Deletion::StillRecording;
    (sql_->mark_deleted.reset() << run).run();
    return Deletion::Deleted;
  });
}

/// The first tick after the first `blocks` blocks of a run; nothing if it has no more.
std::optional<std::uint64_t> RunStore::slice_end(RunId run, std::size_t blocks) {
  Statement& found = sql_->slice_end.reset() << run << std::uint64_t{blocks};
  const ResetLater reset(found);
  if (!found.step()) return std::nullopt;
  return found.count(0);
}

void RunStore::delete_before(RunId run, std::uint64_t tick) {
  (sql_->delete_blocks.reset() << run << tick).run();
  (sql_->delete_gaps.reset() << run << tick).run();
}

std::optional<RunId> RunStore::first_deleted() {
  const ResetLater reset(sql_->deleted.reset() << unsweepable_);
  if (!sql_->deleted.step()) return std::nullopt;
  return sql_->deleted.integer(0);
}

bool RunStore::sweep(std::size_t blocks) {
  require_open();
  const auto run = first_deleted();
  if (!run) return false;
  try {
    return alone([&] {
      const auto end = slice_end(*run, blocks);
      delete_before(*run, end.value_or(kEveryTick));
      if (!end) {
        const ResetLater reset(sql_->delete_run.reset() << *run);
        const std::int64_t document = sql_->delete_run.step() ? sql_->delete_run.integer(0) : *run;
        sql_->delete_run.reset();
        (sql_->delete_document.reset() << document).run();
      }
      return first_deleted().has_value();
    });
  } catch (const DatabaseError& error) {
    if (error.trouble() != Trouble::Damaged) throw;
    unsweepable_ = *run;
    throw StoreError("The deleted run " + std::to_string(*run) +
                     " is damaged: its room cannot be used again.");
  }
}

bool RunStore::requeue_run(RunId run) {
  return guarded([&] {
    begin();
    const ResetLater reset(sql_->requeue_run.reset() << run);
    return sql_->requeue_run.step();
  });
}

bool RunStore::clear_run(RunId run, std::size_t blocks) {
  return alone([&] {
    const auto end = slice_end(run, blocks);
    delete_before(run, end.value_or(kEveryTick));
    return end.has_value();
  });
}

std::optional<RunRow> RunStore::retire_oldest(std::uint64_t limit) {
  if (used_bytes() <= limit || first_deleted()) return std::nullopt;
  return alone([&]() -> std::optional<RunRow> {
    RunRow oldest{};
    {
      Statement& found = sql_->oldest_ended.reset();
      const ResetLater reset(found);
      if (!found.step()) return std::nullopt;
      oldest.id = found.integer(0);
      oldest.status = find_status(found.text(1)).value_or(RunStatus::Finished);
      oldest.what.scenario = found.text(2);
      oldest.what.started = found.text(3);
      oldest.ticks = found.count(4);
      oldest.bytes = found.count(5);
    }
    (sql_->mark_deleted.reset() << oldest.id).run();
    return oldest;
  });
}

/// Drops the oldest block and subtracts it from `left`; false if it must stay.
bool RunStore::drop_block(RunId run, Remains& left, double before, std::string_view sentence) {
  Statement& oldest = sql_->oldest_blocks.reset() << run;
  const ResetLater reset(oldest);
  if (!oldest.step()) return false;
  const std::uint64_t first = oldest.count(0);
  const std::uint64_t last = oldest.count(1);
  const std::uint64_t bytes = oldest.count(3);
  if (last >= left.newest_block) return false;
  // The first tick that stays gives the age of the block before it, to within a tick.
  if (!oldest.step() || oldest.number(2) > before) return false;
  const std::uint64_t kept = oldest.count(0);
  left.kept_from = oldest.number(2);
  left.ticks -= std::min(left.ticks, last - first + 1);
  left.bytes -= std::min(left.bytes, bytes);
  oldest.reset();
  delete_before(run, kept);
  (sql_->insert_gap.reset() << run << std::int64_t{0} << kept - 1 << to_string(GapCause::Dropped)
                            << sentence)
      .run();
  return true;
}

std::size_t RunStore::drop_oldest(RunId run,
                                  double before,
                                  std::size_t blocks,
                                  std::string_view sentence) {
  commit();
  require_open();
  const auto found = open_.find(run);
  if (found == open_.end() || found->second->ticks == 0) return 0;
  Recording& recording = *found->second;
  const bool growing = recording.pending.frames() > 0;
  Remains left{.newest_block = growing ? recording.first_tick : recording.last_tick,
               .ticks = recording.ticks,
               .bytes = recording.sealed_bytes,
               .kept_from = recording.kept_from};
  const std::size_t dropped = alone([&] {
    std::size_t count = 0;
    while (count < blocks && drop_block(run, left, before, sentence)) ++count;
    if (count == 0) return count;
    (sql_->progress.reset() << left.ticks << recording.last_time
                            << left.bytes + recording.block_bytes << run)
        .run();
    return count;
  });
  recording.ticks = left.ticks;
  recording.sealed_bytes = left.bytes;
  recording.kept_from = left.kept_from;
  return dropped;
}

RunStore::Span RunStore::span(RunId run) const {
  const auto found = open_.find(run);
  if (found == open_.end()) return {};
  return {found->second->kept_from, found->second->last_time};
}

std::uint64_t RunStore::pages(Statement& statement) {
  const ResetLater reset(statement.reset());
  return statement.step() ? statement.count(0) : 0;
}

std::uint64_t RunStore::used_bytes() {
  return guarded(
      [&] { return (pages(sql_->page_count) - pages(sql_->free_pages)) * sql_->page_bytes; });
}

std::uint64_t RunStore::log_bytes() const {
  namespace fs = std::filesystem;
  std::error_code error;
  const std::uintmax_t bytes =
      fs::file_size(fs::weakly_canonical(path_, error).string() + "-wal", error);
  return error ? 0 : bytes;
}

void RunStore::fold_log() {
  commit();
  require_open();
  connection_->execute("PRAGMA wal_checkpoint(TRUNCATE)");
}

std::uint64_t RunStore::spare_bytes() {
  return guarded([&] { return pages(sql_->free_pages) * sql_->page_bytes; });
}

}  // namespace db
