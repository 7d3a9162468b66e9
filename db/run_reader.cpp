// db/run_reader.cpp: reads runs while others record.
#include "db/run_reader.hpp"

#include <limits>
#include <map>

#include <unistd.h>

#include "db/schema.hpp"

namespace db {

using detail::Connection;
using detail::ResetLater;
using detail::Statement;

namespace {

constexpr std::string_view kRunColumns =
    "id, status, outcome, reason, scenario, controller, filter, physics, seed, parameters,"
    " version, started, ticks, time, lost_ticks, bytes, metrics";

RunRow row_of(const Statement& found) {
  RunRow row{};
  row.id = found.integer(0);
  row.status = find_status(found.text(1)).value_or(RunStatus::Failed);
  row.outcome = found.text(2);
  row.reason = found.text(3);
  row.what.scenario = found.text(4);
  row.what.controller = found.text(5);
  row.what.filter = found.text(6);
  row.what.physics = found.text(7);
  row.what.seed = found.count(8);
  row.what.parameters = found.text(9);
  row.what.version = found.text(10);
  row.what.started = found.text(11);
  row.ticks = found.count(12);
  row.time = found.number(13);
  row.lost_ticks = found.count(14);
  row.bytes = found.count(15);
  row.metrics = found.text(16);
  return row;
}

// SQLite's integers are signed; no tick or count reaches the upper half.
std::int64_t signed_tick(std::uint64_t tick) {
  constexpr auto kLargest = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  return static_cast<std::int64_t>(std::min(tick, kLargest));
}

Connection open_for_reading(const std::string& path) {
  Connection connection(path, Connection::Mode::Read);
  try {
    detail::require_readable(connection);
    return connection;
  } catch (const DatabaseError&) {
    // In a read-only folder SQLite cannot set up the memory that it shares with a writer. Without a
    // log beside the file there is no writer, and the file is complete.
    if (::access((path + "-wal").c_str(), F_OK) == 0 || ::access(path.c_str(), R_OK) != 0) throw;
    Connection immutable(path, Connection::Mode::ReadImmutable);
    detail::require_readable(immutable);
    return immutable;
  }
}

}  // namespace

struct RunReader::Tables {
  explicit Tables(const std::string& path) : connection(open_for_reading(path)) {}

  Statement& listing(const RunFilter& filter, bool counting) {
    const unsigned key = (filter.scenario ? 1U : 0U) | (filter.controller ? 2U : 0U) |
                         (filter.outcome ? 4U : 0U) | (filter.status ? 8U : 0U) |
                         (counting ? 16U : 0U);
    if (!listings.contains(key)) {
      std::string sql = "SELECT " + std::string(counting ? "count(*)" : kRunColumns) +
                        " FROM run WHERE id < ? AND status <> 'deleted'";
      if (filter.scenario) sql += " AND scenario = ?";
      if (filter.controller) sql += " AND controller = ?";
      if (filter.outcome) sql += " AND outcome = ?";
      if (filter.status) sql += " AND status = ?";
      if (!counting) sql += " ORDER BY id DESC LIMIT ?";
      listings.emplace(key, connection.prepare(sql));
    }
    return listings.at(key).reset();
  }

  Connection connection;
  Statement get = connection.prepare("SELECT " + std::string(kRunColumns) +
                                     ", (SELECT text FROM document WHERE run ="
                                     " coalesce(run.document, run.id))"
                                     " FROM run WHERE id = ? AND status <> 'deleted'");
  // A deleted run disappears at once, though sweeping its blocks may take a while.
  Statement exists = connection.prepare("SELECT 1 FROM run WHERE id = ? AND status <> 'deleted'");
  Statement block = connection.prepare(
      "SELECT first_tick, frames FROM block WHERE run = ?1 AND last_tick >= ?2 AND first_tick >="
      " coalesce((SELECT max(first_tick) FROM block WHERE run = ?1 AND first_tick <= ?2), 0)"
      " ORDER BY first_tick LIMIT 1");
  Statement gaps = connection.prepare(
      "SELECT first_tick, last_tick, cause, sentence FROM gap"
      " WHERE run = ? ORDER BY first_tick");
  std::map<unsigned, Statement> listings{};  // by the set of filters used
};

RunReader::RunReader(const std::string& path) : path_(path) {
  tables();
}

/// The tables of the file that is at the path now.
RunReader::Tables& RunReader::tables() {
  const auto there = identity_of(path_);
  if (!tables_ || there != opened_) {
    tables_.reset();
    block_run_ = 0;
    tables_ = std::make_shared<Tables>(path_);
    opened_ = there;
  }
  return *tables_;
}

namespace {
void bind_filter(Statement& statement, const RunFilter& filter) {
  if (filter.scenario) statement << std::string_view(*filter.scenario);
  if (filter.controller) statement << std::string_view(*filter.controller);
  if (filter.outcome) statement << std::string_view(*filter.outcome);
  if (filter.status) statement << to_string(*filter.status);
}
}  // namespace

RunPage RunReader::list(const RunFilter& filter, std::size_t limit, std::optional<RunId> cursor) {
  Statement& found = tables().listing(filter, false);
  const ResetLater reset(found);
  found << cursor.value_or(std::numeric_limits<RunId>::max());
  bind_filter(found, filter);
  found << signed_tick(limit == SIZE_MAX ? limit : limit + 1);  // one more, to detect a next page
  RunPage page{};
  while (found.step()) {
    if (page.runs.size() == limit) {
      page.next = page.runs.empty() ? cursor : page.runs.back().id;
      break;
    }
    page.runs.push_back(row_of(found));
  }
  return page;
}

std::uint64_t RunReader::count(const RunFilter& filter) {
  Statement& found = tables().listing(filter, true);
  const ResetLater reset(found);
  found << std::numeric_limits<RunId>::max();
  bind_filter(found, filter);
  return found.step() ? found.count(0) : 0;
}

std::optional<RunRow> RunReader::get(RunId run) {
  Tables& from = tables();
  from.get.reset() << run;
  const ResetLater reset(from.get);
  if (!from.get.step()) return std::nullopt;
  RunRow row = row_of(from.get);
  row.what.document = from.get.text(17);
  const ResetLater reset_gaps(from.gaps.reset() << run);
  while (from.gaps.step()) {
    row.gaps.push_back({.first_tick = from.gaps.count(0),
                        .last_tick = from.gaps.count(1),
                        .cause = find_cause(from.gaps.text(2)).value_or(GapCause::Failed),
                        .sentence = from.gaps.text(3)});
  }
  return row;
}

bool RunReader::exists(RunId run) {
  Statement& found = tables().exists.reset() << run;
  const ResetLater reset(found);
  return found.step();
}

/// Unpacks the block that holds `tick`, or the first one after it. Returns the tick to begin with;
/// nothing if there is none. Without `unpack` it only searches.
std::optional<std::uint64_t> RunReader::seek(RunId run, std::uint64_t tick, bool unpack) {
  Statement& block = tables().block.reset() << run << signed_tick(tick);
  const ResetLater reset(block);
  if (!block.step()) return std::nullopt;
  const auto first = block.count(0);
  if (!unpack) return std::max(first, tick);
  block_run_ = 0;
  try {
    decoder_.decode(block.blob(1));
  } catch (const CodecError& error) {
    throw StoreError("Run " + std::to_string(run) + " is damaged at tick " + std::to_string(first) +
                     ": " + error.what() + ".");
  }
  block_first_ = first;
  block_run_ = run;
  return std::max(first, tick);
}

std::optional<std::uint64_t> RunReader::frames(RunId run,
                                               std::uint64_t from,
                                               std::size_t limit,
                                               const FrameSink& sink) {
  std::uint64_t next = from;
  if (!exists(run)) return std::nullopt;
  for (std::size_t done = 0;;) {
    // The block in hand also serves the next page; a block that has grown since is read anew.
    const bool in_hand =
        block_run_ == run && next >= block_first_ && next < block_first_ + decoder_.frames();
    if (!in_hand) {
      const auto found = seek(run, next, done < limit);
      if (!found || done == limit) return found;
      next = *found;
    }
    for (; next < block_first_ + decoder_.frames(); ++next, ++done) {
      if (done == limit) return next;
      sink(next, decoder_.frame(next - block_first_));
    }
  }
}

}  // namespace db
