// db/run_reader.cpp: reads runs while others record.
#include "db/run_reader.hpp"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <limits>

#include <unistd.h>

#include "db/run_query.hpp"
#include "db/schema.hpp"
#include "db/tags.hpp"

namespace db {

using detail::Connection;
using detail::ResetLater;
using detail::RunQuery;
using detail::Statement;

namespace {

constexpr std::string_view kRunColumns =
    "run.id, run.status, run.outcome, reason, run.scenario, run.controller, filter, physics,"
    " run.seed, parameters, version, started, ticks, time, lost_ticks, bytes, metrics, run.kind,"
    " run.batch, verdict_time, last_outcome, last_reason, result, run.label, note, run.tags";
constexpr int kColumns = 26;
// A deleted run disappears at once, though sweeping its blocks may take a while.
constexpr std::string_view kOneRun = " FROM run JOIN listing USING (id) WHERE run.id = ?";

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
  row.what.kind = find_kind(found.text(17)).value_or(RunKind::Session);
  row.what.batch = found.integer(18);
  row.verdict_time = found.number(19);
  row.last_outcome = found.text(20);
  row.last_reason = found.text(21);
  row.result = found.text(22);
  row.label = found.text(23);
  row.note = found.text(24);
  row.tags = detail::tags_of(found.text(25));
  return row;
}

/// About the memory of a row without its document [bytes].
std::size_t size_of(const RunRow& row) {
  constexpr std::size_t kFixed = 1024;
  return kFixed + row.metrics.size() + row.what.parameters.size() + row.reason.size() +
         row.note.size() + row.last_reason.size();
}

// SQLite's integers are signed; no tick or count reaches the upper half.
std::int64_t signed_tick(std::uint64_t tick) {
  constexpr auto kLargest = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  return static_cast<std::int64_t>(std::min(tick, kLargest));
}

Connection open_for_reading(const std::string& path) {
  if (::access(path.c_str(), F_OK) != 0 && (errno == ENOENT || errno == ENOTDIR)) {
    throw DatabaseError("Cannot open the run store " + path + ": there is no such file.",
                        Trouble::Refused);
  }
  if (std::filesystem::is_directory(path)) {
    throw DatabaseError("Cannot open the run store " + path + ": it is a folder.",
                        Trouble::Refused);
  }
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

  Connection connection;
  Statement row = connection.prepare("SELECT " + std::string(kRunColumns) + std::string(kOneRun));
  Statement get = connection.prepare("SELECT " + std::string(kRunColumns) +
                                     ", (SELECT text FROM document WHERE document.run ="
                                     " coalesce(run.document, run.id))" +
                                     std::string(kOneRun));
  Statement exists = connection.prepare("SELECT 1 FROM listing WHERE id = ?");
  Statement block = connection.prepare(
      "SELECT first_tick, frames FROM block WHERE run = ?1 AND last_tick >= ?2 AND first_tick >="
      " coalesce((SELECT max(first_tick) FROM block WHERE run = ?1 AND first_tick <= ?2), 0)"
      " ORDER BY first_tick LIMIT 1");
  Statement gaps = connection.prepare(
      "SELECT first_tick, last_tick, cause, sentence FROM gap"
      " WHERE run = ? ORDER BY first_tick");
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

RunPage RunReader::list(const RunFilter& filter,
                        std::size_t limit,
                        const std::optional<std::string>& cursor,
                        const RunOrder& order,
                        std::size_t room) {
  Tables& from = tables();
  const std::uint64_t more = limit == SIZE_MAX ? limit : limit + 1;  // to detect a next page
  const RunQuery query =
      RunQuery::page(filter, order, cursor, static_cast<std::uint64_t>(signed_tick(more)));
  Statement found = query.prepare(from.connection);
  RunPage page{};
  std::string last = cursor.value_or("");
  std::size_t size = 0;
  while (found.step()) {
    if (page.runs.size() == limit || size >= room) {
      page.next = last;
      break;
    }
    const ResetLater reset(from.row.reset() << found.integer(0));
    if (!from.row.step()) continue;
    page.runs.push_back(row_of(from.row));
    RunRow& row = page.runs.back();
    last = detail::cursor_after(order, row.id, found, 1);
    if (order.grouped && row.what.batch > 0) row.group = group_of(filter, row.what.batch);
    size += size_of(row);
  }
  return page;
}

/// The runs of a batch that the filter passes.
RunGroup RunReader::group_of(const RunFilter& filter, RunId batch) {
  const RunQuery query = RunQuery::results_of_batch(filter, batch);
  Statement found = query.prepare(tables().connection);
  RunGroup group;
  while (found.step()) {
    group.counts[found.text(0)] = found.count(1);
    group.runs += found.count(1);
    group.first = group.first == 0 ? found.integer(2) : std::min(group.first, found.integer(2));
    group.last = std::max(group.last, found.integer(3));
  }
  return group;
}

std::uint64_t RunReader::count(const RunFilter& filter, bool grouped) {
  const RunQuery query = RunQuery::count(filter, grouped);
  Statement found = query.prepare(tables().connection);
  return found.step() ? found.count(0) : 0;
}

std::map<std::string, std::uint64_t> RunReader::results(RunFilter filter) {
  filter.outcome.reset();
  filter.status.reset();
  filter.result.reset();
  const RunQuery query = RunQuery::results(filter);
  Statement found = query.prepare(tables().connection);
  std::map<std::string, std::uint64_t> counts;
  while (found.step()) counts[found.text(0)] = found.count(1);
  return counts;
}

std::optional<RunRow> RunReader::get(RunId run) {
  Tables& from = tables();
  from.get.reset() << run;
  const ResetLater reset(from.get);
  if (!from.get.step()) return std::nullopt;
  RunRow row = row_of(from.get);
  row.what.document = from.get.text(kColumns);
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
