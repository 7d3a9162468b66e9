// db/schema.cpp: the tables and their history.
#include "db/schema.hpp"

#include <array>
#include <string>

namespace db::detail {

namespace {

constexpr std::int64_t kApplicationId = 0x5461754C;  // "TauL": tells our files from others

// Step k brings version k to k + 1. Steps that have been released are never changed; a change of
// the tables is a further step. SI units throughout.
constexpr std::array kSteps = {
    // 1: runs, their plain columns tick by tick, and the frames packed in blocks. The document is
    // kept apart because the run row is rewritten at every commit.
    R"(
    CREATE TABLE run (
      id INTEGER PRIMARY KEY AUTOINCREMENT,
      status TEXT NOT NULL,
      outcome TEXT NOT NULL DEFAULT 'running',
      reason TEXT NOT NULL DEFAULT '',
      scenario TEXT NOT NULL,
      controller TEXT NOT NULL,
      filter TEXT NOT NULL,
      vehicle TEXT NOT NULL,
      seed INTEGER NOT NULL,
      parameters TEXT NOT NULL,
      version TEXT NOT NULL,
      started TEXT NOT NULL,
      ticks INTEGER NOT NULL DEFAULT 0,
      time REAL NOT NULL DEFAULT 0,
      lost_ticks INTEGER NOT NULL DEFAULT 0,
      bytes INTEGER NOT NULL DEFAULT 0,
      metrics TEXT NOT NULL DEFAULT ''
    );
    CREATE TABLE document (run INTEGER PRIMARY KEY, text TEXT NOT NULL);
    CREATE TABLE tick (
      run INTEGER NOT NULL,
      tick INTEGER NOT NULL,
      t REAL, x REAL, y REAL, heading REAL, v REAL, omega REAL, clearance REAL,
      hold INTEGER NOT NULL,
      behaviour INTEGER NOT NULL,
      PRIMARY KEY (run, tick)
    ) WITHOUT ROWID;
    CREATE TABLE block (
      run INTEGER NOT NULL,
      first_tick INTEGER NOT NULL,
      last_tick INTEGER NOT NULL,
      frames BLOB NOT NULL,
      PRIMARY KEY (run, first_tick)
    );
    )",
    // 2: listing by scenario and finding what is not finished without reading every run.
    R"(
    CREATE INDEX run_by_scenario ON run (scenario, id);
    CREATE INDEX run_by_status ON run (status, id);
    )",
    // 3: which ticks a run lacks, and why.
    R"(
    CREATE TABLE gap (
      run INTEGER NOT NULL,
      first_tick INTEGER NOT NULL,
      last_tick INTEGER NOT NULL,
      cause TEXT NOT NULL,
      sentence TEXT NOT NULL,
      PRIMARY KEY (run, first_tick)
    ) WITHOUT ROWID;
    )",
    // 4: a run with the same document as the one before it shares that one's, which stays as long
    // as a run has it: ten thousand repeats of a world would fill the store with copies of it.
    R"(
    ALTER TABLE run ADD COLUMN document INTEGER;
    CREATE INDEX run_by_document ON run (document) WHERE document IS NOT NULL;
    )",
};

constexpr std::int64_t kOldestReadable = 2;
constexpr std::int64_t kWithGaps = 3;
constexpr std::int64_t kWithSharedDocuments = 4;

std::int64_t version_of(const Connection& connection) {
  return connection.query_integer("PRAGMA user_version");
}

void refuse_foreign(const Connection& connection) {
  const std::int64_t id = connection.query_integer("PRAGMA application_id");
  if (id == kApplicationId) return;
  if (id != 0 || connection.query_integer("SELECT count(*) FROM sqlite_master") != 0) {
    throw StoreError("The file " + connection.path() +
                     " is a database of another program; choose another file for the run store.");
  }
}

void refuse_newer(const Connection& connection) {
  const std::int64_t version = version_of(connection);
  if (version > schema_version()) {
    throw StoreError("The run store " + connection.path() + " has version " +
                     std::to_string(version) +
                     ", written by a newer program; this one reads up to " +
                     std::to_string(schema_version()) + ".");
  }
}

}  // namespace

int schema_version() {
  return static_cast<int>(kSteps.size());
}

void migrate(Connection& connection) {
  refuse_foreign(connection);
  refuse_newer(connection);
  if (version_of(connection) == schema_version()) return;
  try {
    connection.execute("BEGIN IMMEDIATE");
    // Again, now that no one else can migrate it in between.
    refuse_newer(connection);
    for (auto step = static_cast<std::size_t>(version_of(connection)); step < kSteps.size();
         ++step) {
      connection.execute(kSteps[step]);
    }
    connection.execute("PRAGMA application_id = " + std::to_string(kApplicationId));
    connection.execute("PRAGMA user_version = " + std::to_string(schema_version()));
    connection.execute("COMMIT");
  } catch (...) {
    connection.roll_back();
    throw;
  }
}

void require_readable(const Connection& connection) {
  refuse_foreign(connection);
  refuse_newer(connection);
  if (version_of(connection) < kOldestReadable) {
    throw StoreError("The run store " + connection.path() +
                     " is empty or of an older version; start the server on it once.");
  }
}

bool has_gaps(const Connection& connection) {
  return version_of(connection) >= kWithGaps;
}

bool shares_documents(const Connection& connection) {
  return version_of(connection) >= kWithSharedDocuments;
}

}  // namespace db::detail
