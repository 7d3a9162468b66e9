// db/records.hpp: the inputs and outputs of the run store: numbers, bytes and text.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace db {

/// Row number of a run, from 1. Never reused in one database, even after a deletion.
using RunId = std::int64_t;

/// Issues run numbers, even before their rows are written. Callable from any thread.
class RunNumbers {
 public:
  RunId take() { return next_.fetch_add(1); }
  /// Marks the numbers up to `used` as taken.
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
  Interrupted,  // the program ended before the run
  Cancelled,
  Failed,
};

/// "queued", "recording", ..., as in the database and in REST.
std::string_view to_string(RunStatus status);
std::optional<RunStatus> find_status(std::string_view name);

/// All data of a run before its first tick; enough to run it again.
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
  std::string metrics{};  // JSON text; empty if there are none
  std::uint64_t lost_ticks = 0;
};

/// Why the record of a run lacks ticks.
enum class GapCause : std::uint8_t {
  Pause,    // nothing happened, so nothing was recorded
  Behind,   // the store was too slow
  Failed,   // writing the store failed
  Full,     // the store was full of finished runs
  Dropped,  // a live run dropped its oldest ticks for newer ones
};
std::string_view to_string(GapCause cause);
std::optional<GapCause> find_cause(std::string_view name);

/// A range of ticks missing from the record, both ends included.
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
  NewRun what{};  // only RunReader::get fills `document`
  std::uint64_t ticks = 0;
  double time = 0;  // [s] run clock of the newest tick
  std::uint64_t lost_ticks = 0;
  std::uint64_t bytes = 0;  // of its packed frames
  std::string metrics{};    // JSON text; empty if there are none
  std::vector<Gap> gaps{};  // filled only by RunReader::get
};

/// Unset fields match everything.
struct RunFilter {
  std::optional<std::string> scenario{};
  std::optional<std::string> controller{};
  std::optional<std::string> outcome{};
  std::optional<RunStatus> status{};
};

/// One page of a list, and the cursor of the next page, absent on the last.
struct RunPage {
  std::vector<RunRow> runs{};
  std::optional<RunId> next{};
};

}  // namespace db
