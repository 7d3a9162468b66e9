// db/run_store_parts.hpp: code shared by the store's source files: its statements and open runs.
#pragma once

#include <memory>
#include <utility>

#include "db/run_store.hpp"

namespace db {

struct RunStore::Recording {
  explicit Recording(std::shared_ptr<detail::Compressor> compressor)
      : pending(std::move(compressor)) {}

  BlockEncoder pending;            // frames of the newest block, which may still grow
  std::uint64_t first_tick = 0;    // of that block
  std::size_t written_frames = 0;  // frames of pending that are in the block row already
  std::uint64_t sealed_bytes = 0;  // of the blocks before it
  std::uint64_t block_bytes = 0;   // of that block's row
  std::uint64_t ticks = 0;
  double first_time = 0;  // [s] of that block's first tick
  std::uint64_t last_tick = 0;
  double last_time = 0;  // [s]
  double kept_from = 0;  // [s] of the oldest tick
  bool dirty = false;    // the run row lacks the newest tick
};

struct RunStore::Statements {
  explicit Statements(const detail::Connection& connection) : c(connection) {}

  const detail::Connection& c;
  detail::Statement begin = c.prepare("BEGIN IMMEDIATE");
  detail::Statement commit = c.prepare("COMMIT");
  detail::Statement insert_run = c.prepare(
      "INSERT INTO run (id, status, scenario, controller, filter, physics, seed, parameters,"
      " version, started, kind, batch)"
      " VALUES (?1, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, iif(?12 < 0, ?1, ?12))");
  detail::Statement insert_document = c.prepare("INSERT INTO document (run, text) VALUES (?, ?)");
  detail::Statement same_document = c.prepare("SELECT 1 FROM document WHERE run = ? AND text = ?");
  detail::Statement share_document = c.prepare("UPDATE run SET document = ? WHERE id = ?");
  detail::Statement start_run = c.prepare(
      "UPDATE run SET status = 'recording', started = ? WHERE id = ? AND status = 'queued'"
      " RETURNING id");
  detail::Statement resume_run = c.prepare(
      "UPDATE run SET status = 'recording', reason = '' WHERE id = ?"
      " AND status IN ('recording', 'interrupted')"
      " RETURNING ticks, time, bytes");
  detail::Statement requeue_run = c.prepare(
      "UPDATE run SET status = 'queued', outcome = 'running', reason = '', metrics = '',"
      " last_outcome = '', last_reason = '', ticks = 0, time = 0, lost_ticks = 0, bytes = 0"
      " WHERE id = ? AND status IN ('interrupted', 'cancelled', 'failed') AND trashed = 0"
      " RETURNING id");
  detail::Statement write_block = c.prepare(
      "INSERT INTO block (run, first_tick, last_tick, first_time, frames)"
      " VALUES (?, ?, ?, ?, ?)"
      " ON CONFLICT (run, first_tick) DO UPDATE"
      " SET last_tick = excluded.last_tick, frames = excluded.frames");
  detail::Statement insert_gap = c.prepare("INSERT OR REPLACE INTO gap VALUES (?, ?, ?, ?, ?)");
  detail::Statement lost_ticks = c.prepare(
      "SELECT coalesce(sum(last_tick - first_tick + 1), 0) FROM gap"
      " WHERE run = ? AND cause NOT IN ('pause', 'dropped')");
  detail::Statement progress =
      c.prepare("UPDATE run SET ticks = ?, time = ?, bytes = ? WHERE id = ?");
  detail::Statement set_result = c.prepare(
      "UPDATE run SET outcome = ?, reason = ?, metrics = ?, last_outcome = ?, last_reason = ?"
      " WHERE id = ? AND status <> 'deleted' RETURNING id");
  detail::Statement end_run = c.prepare(
      "UPDATE run SET status = ?, outcome = ?, reason = ?, metrics = ?, lost_ticks = ?,"
      " last_outcome = ?, last_reason = ? WHERE id = ?");
  detail::Statement status = c.prepare("SELECT status FROM run WHERE id = ?");
  detail::Statement mark_deleted =
      c.prepare("UPDATE run SET status = 'deleted', trashed = 0 WHERE id = ?");
  detail::Statement trash = c.prepare(
      "UPDATE run SET trashed = ? WHERE id = ? AND trashed = 0"
      " AND status NOT IN ('queued', 'recording', 'deleted') RETURNING id");
  detail::Statement restore = c.prepare(
      "UPDATE run SET trashed = 0 WHERE id = ? AND trashed > 0 AND status <> 'deleted'"
      " RETURNING id");
  detail::Statement in_trash =
      c.prepare("SELECT 1 FROM run WHERE trashed > 0 AND trashed <= ? LIMIT 1");
  detail::Statement empty_trash = c.prepare(
      "UPDATE run SET status = 'deleted', trashed = 0 WHERE id IN"
      " (SELECT id FROM run WHERE trashed > 0 AND trashed <= ? ORDER BY trashed, id LIMIT ?)"
      " RETURNING id");
  detail::Statement is_there =
      c.prepare("SELECT status FROM run WHERE id = ? AND trashed = 0 AND status <> 'deleted'");
  detail::Statement remark = c.prepare(
      "UPDATE run SET label = coalesce(?, label), note = coalesce(?, note),"
      " tags = coalesce(?, tags) WHERE id = ? AND trashed = 0 AND status <> 'deleted'"
      " RETURNING id");
  detail::Statement tags = c.prepare("SELECT tags FROM run WHERE id = ?");
  detail::Statement batch = c.prepare(
      "SELECT id FROM run WHERE batch = ? AND batch > 0 AND trashed = 0 AND status <> 'deleted'"
      " ORDER BY id");
  detail::Statement oldest_ended = c.prepare(
      "SELECT id, status, scenario, started, ticks, bytes FROM run"
      " WHERE status NOT IN ('queued', 'recording', 'deleted') ORDER BY id LIMIT 1");
  detail::Statement deleted = c.prepare(
      "SELECT id FROM run WHERE status = 'deleted' AND id > ?"
      " ORDER BY id LIMIT 1");
  detail::Statement slice_end = c.prepare(
      "SELECT first_tick FROM block WHERE run = ?"
      " ORDER BY first_tick LIMIT 1 OFFSET ?");
  detail::Statement delete_blocks = c.prepare("DELETE FROM block WHERE run = ? AND first_tick < ?");
  detail::Statement delete_gaps = c.prepare("DELETE FROM gap WHERE run = ? AND first_tick < ?");
  detail::Statement delete_run =
      c.prepare("DELETE FROM run WHERE id = ? RETURNING coalesce(document, id)");
  detail::Statement delete_document = c.prepare(
      "DELETE FROM document WHERE run = ?1"
      " AND NOT EXISTS (SELECT 1 FROM run WHERE id = ?1)"
      " AND NOT EXISTS (SELECT 1 FROM run WHERE document = ?1)");
  detail::Statement oldest_blocks = c.prepare(
      "SELECT first_tick, last_tick, first_time, length(frames)"
      " FROM block WHERE run = ? ORDER BY first_tick LIMIT 2");
  detail::Statement newest_tick = c.prepare(
      "SELECT last_tick FROM block WHERE run = ?"
      " ORDER BY first_tick DESC LIMIT 1");
  detail::Statement page_count = c.prepare("PRAGMA page_count");
  detail::Statement free_pages = c.prepare("PRAGMA freelist_count");
  std::uint64_t page_bytes = static_cast<std::uint64_t>(c.query_integer("PRAGMA page_size"));
  RunId newest_document = 0;  // the run that it is stored with
};

/// Runs `action`. If the database fails in it, undoes everything since the last commit.
template <typename Action>
auto RunStore::guarded(const Action& action) {
  require_open();
  try {
    return action();
  } catch (const DatabaseError& error) {
    // A transaction that could not begin needs no undoing.
    if (error.trouble() == Trouble::Busy && !connection_->in_transaction()) throw;
    connection_->roll_back();
    open_.clear();
    failure_ = error;
    throw;
  }
}

/// Runs `action` in its own transaction, so that its failure costs no recording.
template <typename Action>
auto RunStore::alone(const Action& action) {
  commit();
  require_open();
  try {
    begin();
    auto result = action();
    sql_->commit.reset().run();
    return result;
  } catch (const StoreError&) {
    connection_->roll_back();
    throw;
  }
}

}  // namespace db
