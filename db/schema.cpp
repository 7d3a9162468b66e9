// db/schema.cpp: the tables.
#include "db/schema.hpp"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

namespace db::detail {

namespace {

constexpr std::int64_t kApplicationId = 0x5461754C;  // "TauL": distinguishes our files

// The version counts the formats of the tables and of the frames in their blocks. A file of another
// version is not read. 8: layers in 16 bits. 9: adds kAdded.
constexpr std::int64_t kVersion = 9;
constexpr std::int64_t kMended = 8;  // brought up to date

constexpr std::size_t kHeadBytes = 100;  // of a database

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

// `listing` has what a list of runs filters and sorts by, in narrow rows: a search reads it alone.
// Triggers keep it; a run that is deleted or in the trash is not in it. Tags are lines, each
// between two line breaks.
constexpr const char* kAdded = R"(
    ALTER TABLE run ADD COLUMN kind TEXT NOT NULL DEFAULT 'session';
    ALTER TABLE run ADD COLUMN batch INTEGER NOT NULL DEFAULT 0;
    ALTER TABLE run ADD COLUMN last_outcome TEXT NOT NULL DEFAULT '';
    ALTER TABLE run ADD COLUMN last_reason TEXT NOT NULL DEFAULT '';
    ALTER TABLE run ADD COLUMN label TEXT NOT NULL DEFAULT '';
    ALTER TABLE run ADD COLUMN note TEXT NOT NULL DEFAULT '';
    ALTER TABLE run ADD COLUMN tags TEXT NOT NULL DEFAULT '';
    ALTER TABLE run ADD COLUMN trashed INTEGER NOT NULL DEFAULT 0;
    CREATE INDEX run_by_batch ON run (batch) WHERE batch > 0;
    CREATE INDEX run_by_trash ON run (trashed) WHERE trashed > 0;
    CREATE VIEW listed AS SELECT id, status, outcome, kind, batch, seed, scenario, controller, label,
        tags,
        iif(outcome IN ('running', 'stopped') AND status <> 'finished', status, outcome) AS result,
        coalesce(json_extract(nullif(metrics, ''), '$.time'), time) AS verdict_time,
        json_extract(nullif(metrics, ''), '$.path_length') AS path_length,
        json_extract(nullif(metrics, ''), '$.min_clearance') AS min_clearance,
        json_extract(nullif(metrics, ''), '$.intrusion') AS intrusion,
        json_extract(nullif(metrics, ''), '$.turning') AS turning,
        lower(id || ' ' || label || ' ' || scenario || ' ' || controller || ' ' || filter || ' ' ||
          note || tags) AS words
      FROM run WHERE trashed = 0 AND status <> 'deleted';
    CREATE TABLE listing (id INTEGER PRIMARY KEY, status TEXT, outcome TEXT, kind TEXT,
      batch INTEGER, seed INTEGER, scenario TEXT, controller TEXT, label TEXT, tags TEXT, result TEXT,
      verdict_time REAL, path_length REAL, min_clearance REAL, intrusion REAL, turning REAL,
      words TEXT);
    CREATE TRIGGER run_begins AFTER INSERT ON run BEGIN
      INSERT INTO listing SELECT * FROM listed WHERE id = new.id;
    END;
    CREATE TRIGGER run_changes AFTER UPDATE OF status, outcome, kind, batch, label, note, tags,
        metrics, time, trashed ON run BEGIN
      DELETE FROM listing WHERE id = new.id;
      INSERT INTO listing SELECT * FROM listed WHERE id = new.id;
    END;
    CREATE TRIGGER run_goes AFTER DELETE ON run BEGIN
      DELETE FROM listing WHERE id = old.id;
    END;
)";

// Only a headless run's document has a pace.
constexpr const char* kMend = R"(
    DROP INDEX run_by_scenario;
    UPDATE run SET kind = 'background' WHERE EXISTS
      (SELECT 1 FROM document WHERE document.run = coalesce(run.document, run.id)
        AND json_type(text, '$.pace') IS NOT NULL);
    DELETE FROM listing;
    INSERT INTO listing SELECT * FROM listed;
)";

std::int64_t version_of(const Connection& connection) {
  return connection.query_integer("PRAGMA user_version");
}

bool is_foreign(const Connection& connection) {
  const std::int64_t id = connection.query_integer("PRAGMA application_id");
  if (id == kApplicationId) return false;
  return id != 0 || connection.query_integer("SELECT count(*) FROM sqlite_master") != 0;
}

/// `fault`: what is wrong with it.
[[noreturn]] void refuse_file(const std::string& path, const std::string& fault) {
  throw DatabaseError(
      "The file " + path + " is " + fault + "; choose another file for the run store.",
      Trouble::Refused);
}

constexpr const char* kForeign = "a database of another program";

void refuse_foreign(const Connection& connection) {
  if (is_foreign(connection)) refuse_file(connection.path(), kForeign);
}

/// Refuses a file of a version before `oldest` or after this program's, unless it is empty.
void refuse_others(const Connection& connection, std::int64_t oldest) {
  const std::int64_t version = version_of(connection);
  if (version > kVersion) {
    throw StoreError(
        "The run store " + connection.path() + " has version " + std::to_string(version) +
        ", written by a newer program; this one reads version " + std::to_string(kVersion) + ".");
  }
  if (version > 0 && version < oldest) {
    throw DatabaseError("The run store " + connection.path() + " has version " +
                            std::to_string(version) +
                            ", written by an older program; this one reads version " +
                            std::to_string(kVersion) + ".",
                        Trouble::Outdated);
  }
}

/// The first bytes of a file, as many as there are.
std::string head_of(const std::string& path) {
  std::string head(kHeadBytes, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), kHeadBytes);
  head.resize(static_cast<std::size_t>(file.gcount()));
  return head;
}

/// The application id in the head of a database, which is ours once its log was folded in.
std::int64_t id_in(std::string_view head) {
  constexpr std::size_t kAt = 68;  // https://www.sqlite.org/fileformat.html
  std::int64_t id = 0;
  for (const char byte : head.substr(kAt, 4)) id = 256 * id + static_cast<unsigned char>(byte);
  return id;
}

}  // namespace

void refuse_other_files(const std::string& path) {
  constexpr std::string_view kMagic("SQLite format 3\0", 16);
  std::error_code none;
  if (!std::filesystem::is_regular_file(path, none)) return;
  const std::string head = head_of(path);
  if (head.empty()) return;
  if (!head.starts_with(kMagic) || head.size() < kHeadBytes) refuse_file(path, "not a database");
  bool foreign = false;
  try {
    foreign = is_foreign(Connection(path, Connection::Mode::Read));  // changes no byte
  } catch (const DatabaseError& error) {
    if (error.trouble() == Trouble::Damaged && id_in(head) != kApplicationId) {
      refuse_file(path, "damaged, or a database of another program");
    }
  }
  if (foreign) refuse_file(path, kForeign);
}

void set_up(Connection& connection) {
  refuse_foreign(connection);
  refuse_others(connection, kMended);
  if (version_of(connection) == kVersion) return;
  try {
    connection.execute("BEGIN IMMEDIATE");
    // Check again, now that no other program can set it up in between.
    refuse_others(connection, kMended);
    if (version_of(connection) != kVersion) {
      const bool older = version_of(connection) == kMended;
      if (!older) connection.execute(kTables);
      connection.execute(kAdded);
      if (older) connection.execute(kMend);
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
  if (version_of(connection) == kMended) {
    throw DatabaseError("The run store " + connection.path() +
                            " was written by an older program; start the server on it once, which "
                            "brings it up to date.",
                        Trouble::Outdated);
  }
  refuse_others(connection, kVersion);
  if (version_of(connection) != kVersion) {
    throw StoreError("The run store " + connection.path() +
                     " is empty; start the server on it once.");
  }
}

}  // namespace db::detail
