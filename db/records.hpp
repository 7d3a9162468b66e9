// db/records.hpp: the inputs and outputs of the run store: numbers, bytes and text.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
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

enum class RunKind : std::uint8_t {
  Session,     // driven live
  Background,  // headless, from its start to its end
};
std::string_view to_string(RunKind kind);
std::optional<RunKind> find_kind(std::string_view name);

/// NewRun::batch of the first run of a batch, whose number the batch gets.
constexpr RunId kNewBatch = -1;

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
  RunKind kind = RunKind::Session;
  RunId batch = 0;  // 0: not of a batch
};

/// The first outcome of a run, and its outcome now if the run has gone on since.
struct RunVerdict {
  std::string outcome{};
  std::string reason{};        // a sentence
  std::string metrics{};       // JSON text; empty if there are none
  std::string last_outcome{};  // empty: the run has not gone on
  std::string last_reason{};
};

struct RunEnd {
  RunStatus status = RunStatus::Finished;
  std::string outcome{};
  std::string reason{};   // a sentence
  std::string metrics{};  // JSON text; empty if there are none
  std::uint64_t lost_ticks = 0;
  std::string last_outcome{};  // as in RunVerdict
  std::string last_reason{};
};

/// What people write on a run. Unset fields stay as they are.
struct RunRemarks {
  std::optional<std::string> label{};
  std::optional<std::string> note{};
  std::optional<std::vector<std::string>> tags{};
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

/// The runs of one batch that a list shows as one line.
struct RunGroup {
  std::uint64_t runs = 0;
  RunId first = 0;
  RunId last = 0;
  std::map<std::string, std::uint64_t> counts{};  // by RunRow::result
};

struct RunRow {
  RunId id = 0;
  RunStatus status = RunStatus::Queued;
  std::string outcome = "running";
  std::string reason{};
  NewRun what{};  // only RunReader::get fills `document`
  std::uint64_t ticks = 0;
  double time = 0;          // [s] run clock of the newest tick
  double verdict_time = 0;  // [s] at which it reached its outcome; as `time` while it has none
  std::uint64_t lost_ticks = 0;
  std::uint64_t bytes = 0;     // of its packed frames
  std::string metrics{};       // JSON text, at its verdict; empty if there are none
  std::string last_outcome{};  // of a run that went on after its verdict, else empty
  std::string last_reason{};
  std::string result{};  // its outcome, or its status while it has none
  std::string label{};
  std::string note{};
  std::vector<std::string> tags{};
  std::vector<Gap> gaps{};          // filled only by RunReader::get
  std::optional<RunGroup> group{};  // set if this is the newest run of a line
};

/// Which runs a list shows. Unset fields match everything.
struct RunFilter {
  std::optional<std::string> scenario{};
  std::optional<std::string> controller{};
  std::optional<std::string> outcome{};
  std::optional<RunStatus> status{};
  std::optional<std::string> result{};  // as in RunRow
  std::optional<RunKind> kind{};
  std::optional<std::uint64_t> seed{};
  std::optional<std::string> tag{};
  std::optional<RunId> batch{};
  /// Each must occur in the label, scenario, controller, filter, note, tags or number. Lower case.
  std::vector<std::string> words{};
};

struct RunOrder {
  std::string by = "id";  // one of sort_names()
  bool descending = true;
  bool grouped = false;  // each batch is one line, which stands where its newest run stands
};
/// The names that a list can be sorted by.
std::span<const std::string_view> sort_names();

/// One page of a list, and the cursor of the next page, absent on the last.
struct RunPage {
  std::vector<RunRow> runs{};
  std::optional<std::string> next{};
};

}  // namespace db
