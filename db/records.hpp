// db/records.hpp: what the run store takes and gives: numbers, bytes and text.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace db {

/// Row number of a run, from 1. Never given out twice in one database, not even after a deletion.
using RunId = std::int64_t;

/// Hands out run numbers, also before the rows that bear them are written. Any thread.
class RunNumbers {
 public:
  RunId take() { return next_.fetch_add(1); }
  /// Those up to `used` are taken.
  void beyond(RunId used) {
    RunId next = next_.load();
    while (next <= used && !next_.compare_exchange_weak(next, used + 1)) {
    }
  }

 private:
  std::atomic<RunId> next_{1};
};

enum class RunStatus : std::uint8_t {
  Queued,
  Recording,
  Finished,
  Interrupted,  // the program ended before the run did
  Cancelled,
  Failed,
};

/// "queued", "recording", ...: as in the database and in REST.
std::string_view to_string(RunStatus status);
std::optional<RunStatus> find_status(std::string_view name);

/// All that is known of a run before its first tick; enough to run it again.
struct NewRun {
  std::string scenario{};  // its name
  std::string document{};  // the scenario as JSON text
  std::string controller{};
  std::string filter{};
  std::string physics{};
  std::uint64_t seed = 0;
  std::string parameters = "{}";  // JSON text
  std::string version{};          // of the program
  std::string started{};          // wall time, ISO 8601
};

struct RunEnd {
  RunStatus status = RunStatus::Finished;
  std::string outcome{};
  std::string reason{};   // a sentence
  std::string metrics{};  // JSON text; empty when there are none
  std::uint64_t lost_ticks = 0;
};

/// Why ticks of a run are not in its record.
enum class GapCause : std::uint8_t {
  Pause,    // nothing happened, and so nothing was recorded
  Behind,   // the store took them too slowly
  Failed,   // the store could not be written
  Full,     // the store was full of finished runs
  Dropped,  // a live run gave its oldest ticks up for newer ones
};
std::string_view to_string(GapCause cause);
std::optional<GapCause> find_cause(std::string_view name);

/// A stretch of ticks that are not in the record, both ends included.
struct Gap {
  std::uint64_t first_tick = 0;
  std::uint64_t last_tick = 0;
  GapCause cause = GapCause::Behind;
  std::string sentence{};
  bool operator==(const Gap&) const = default;
};

struct RunRow {
  RunId id = 0;
  RunStatus status = RunStatus::Queued;
  std::string outcome = "running";
  std::string reason{};
  NewRun what{};  // `document` is filled by RunReader::get only
  std::uint64_t ticks = 0;
  double time = 0;  // [s] run clock of the newest tick
  std::uint64_t lost_ticks = 0;
  std::uint64_t bytes = 0;  // of its packed frames
  std::string metrics{};    // JSON text; empty when there are none
  std::vector<Gap> gaps{};  // filled by RunReader::get only
};

/// Unset fields match everything.
struct RunFilter {
  std::optional<std::string> scenario{};
  std::optional<std::string> controller{};
  std::optional<std::string> outcome{};
  std::optional<RunStatus> status{};
};

/// A part of a list, and where to go on: the next page's cursor, absent on the last page.
struct RunPage {
  std::vector<RunRow> runs{};
  std::optional<RunId> next{};
};

}  // namespace db
