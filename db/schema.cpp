// db/schema.cpp: the tables.
#include "db/schema.hpp"

#include <cstdint>
#include <string>

namespace db::detail {

namespace {

constexpr std::int64_t kApplicationId = 0x5461754C;  // "TauL": distinguishes our files

// The version counts the formats of the tables and of the frames in their blocks. A file of another
// version is not read. 8: layers in 16 bits.
constexpr std::int64_t kVersion = 8;

// SI units throughout. A run with the same document as the previous one shares its row, which stays
// as long as any run uses it: ten thousand repeats of a world would fill the store with copies.
// Documents have their own table because the run row is rewritten at every commit.
constexpr const char* kTables = R"(
    CREATE TABLE run (
      id INTEGER PRIMARY KEY AUTOINCREMENT,
      status TEXT NOT NULL,
      outcome TEXT NOT NULL DEFAULT 'running',
      reason TEXT NOT NULL DEFAULT '',
      scenario TEXT NOT NULL,
      controller TEXT NOT NULL,
      filter TEXT NOT NULL,
      physics TEXT NOT NULL,
      seed INTEGER NOT NULL,
      parameters TEXT NOT NULL,
      version TEXT NOT NULL,
      started TEXT NOT NULL,
      ticks INTEGER NOT NULL DEFAULT 0,
      time REAL NOT NULL DEFAULT 0,
      lost_ticks INTEGER NOT NULL DEFAULT 0,
      bytes INTEGER NOT NULL DEFAULT 0,
      metrics TEXT NOT NULL DEFAULT '',
      document INTEGER
    );
    CREATE INDEX run_by_scenario ON run (scenario, id);
    CREATE INDEX run_by_status ON run (status, id);
    CREATE INDEX run_by_document ON run (document) WHERE document IS NOT NULL;
    CREATE TABLE document (run INTEGER PRIMARY KEY, text TEXT NOT NULL);
    CREATE TABLE block (
      run INTEGER NOT NULL,
      first_tick INTEGER NOT NULL,
      last_tick INTEGER NOT NULL,
      first_time REAL NOT NULL,
      frames BLOB NOT NULL,
      PRIMARY KEY (run, first_tick)
    );
    CREATE TABLE gap (
      run INTEGER NOT NULL,
      first_tick INTEGER NOT NULL,
      last_tick INTEGER NOT NULL,
      cause TEXT NOT NULL,
      sentence TEXT NOT NULL,
      PRIMARY KEY (run, first_tick)
    ) WITHOUT ROWID;
)";

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

/// Refuses a file of another version, unless it is empty.
void refuse_others(const Connection& connection) {
  const std::int64_t version = version_of(connection);
  if (version > kVersion) {
    throw StoreError(
        "The run store " + connection.path() + " has version " + std::to_string(version) +
        ", written by a newer program; this one reads version " + std::to_string(kVersion) + ".");
  }
  if (version > 0 && version < kVersion) {
    throw DatabaseError("The run store " + connection.path() + " has version " +
                            std::to_string(version) +
                            ", written by an older program; this one reads version " +
                            std::to_string(kVersion) + ".",
                        Trouble::Outdated);
  }
}

}  // namespace

void set_up(Connection& connection) {
  refuse_foreign(connection);
  refuse_others(connection);
  if (version_of(connection) == kVersion) return;
  try {
    connection.execute("BEGIN IMMEDIATE");
    // Check again, now that no other program can set it up in between.
    refuse_others(connection);
    if (version_of(connection) != kVersion) {
      connection.execute(kTables);
      connection.execute("PRAGMA application_id = " + std::to_string(kApplicationId));
      connection.execute("PRAGMA user_version = " + std::to_string(kVersion));
    }
    connection.execute("COMMIT");
  } catch (...) {
    connection.roll_back();
    throw;
  }
}

void require_readable(const Connection& connection) {
  refuse_foreign(connection);
  refuse_others(connection);
  if (version_of(connection) != kVersion) {
    throw StoreError("The run store " + connection.path() +
                     " is empty; start the server on it once.");
  }
}

}  // namespace db::detail
