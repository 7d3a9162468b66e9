// tests/db/schema_test.cpp: databases of older and newer versions.
#include "db/schema.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "tests/db/store_files.hpp"
#include <gmock/gmock.h>

namespace {

using db::RunReader;
using db::RunStore;
using db::detail::Connection;
using test::refusal;
using testing::HasSubstr;

class SchemaTest : public test::StoreFiles {
 protected:
  std::int64_t ask(const std::string& sql) {
    return Connection(path, Connection::Mode::Write).query_integer(sql);
  }
  std::string bytes() const {
    std::stringstream all;
    all << std::ifstream(path, std::ios::binary).rdbuf();
    return all.str();
  }
};

// As version 1 wrote it: no listing indexes.
constexpr const char* kVersion1 = R"(
  PRAGMA application_id = 1415673164;
  PRAGMA user_version = 1;
  CREATE TABLE run (id INTEGER PRIMARY KEY AUTOINCREMENT, status TEXT NOT NULL,
    outcome TEXT NOT NULL DEFAULT 'running', reason TEXT NOT NULL DEFAULT '', scenario TEXT NOT NULL,
    controller TEXT NOT NULL, filter TEXT NOT NULL, vehicle TEXT NOT NULL, seed INTEGER NOT NULL,
    parameters TEXT NOT NULL, version TEXT NOT NULL, started TEXT NOT NULL,
    ticks INTEGER NOT NULL DEFAULT 0, time REAL NOT NULL DEFAULT 0,
    lost_ticks INTEGER NOT NULL DEFAULT 0, bytes INTEGER NOT NULL DEFAULT 0,
    metrics TEXT NOT NULL DEFAULT '');
  CREATE TABLE document (run INTEGER PRIMARY KEY, text TEXT NOT NULL);
  CREATE TABLE tick (run INTEGER NOT NULL, tick INTEGER NOT NULL, t REAL, x REAL, y REAL,
    heading REAL, v REAL, omega REAL, clearance REAL, hold INTEGER NOT NULL,
    behaviour INTEGER NOT NULL, PRIMARY KEY (run, tick)) WITHOUT ROWID;
  CREATE TABLE block (run INTEGER NOT NULL, first_tick INTEGER NOT NULL, last_tick INTEGER NOT NULL,
    frames BLOB NOT NULL, PRIMARY KEY (run, first_tick));
  INSERT INTO run (id, status, outcome, scenario, controller, filter, vehicle, seed, parameters,
    version, started, ticks, time) VALUES (7, 'finished', 'reached', 'case3', 'original', 'median',
    'bullet', 5, '{}', '0.0.9', '2026-01-01T00:00:00Z', 1, 0.026);
  INSERT INTO document VALUES (7, '{"name":"case3"}');
  INSERT INTO tick VALUES (7, 0, 0.026, 1, 2, 3, 4, 5, 6, 1, 2);
)";

TEST_F(SchemaTest, AnOlderDatabaseIsRefusedUntouched) {
  Connection(path, Connection::Mode::Write).execute(kVersion1);
  EXPECT_THAT(refusal([&] { const RunReader reader(path); }), HasSubstr("older program"));
  try {
    const RunStore store(path);
    FAIL() << "opened";
  } catch (const db::DatabaseError& error) {
    EXPECT_EQ(error.trouble(), db::Trouble::Outdated);
    EXPECT_THAT(error.what(), HasSubstr("older program"));
  }
  EXPECT_EQ(ask("PRAGMA user_version"), 1);
  EXPECT_EQ(ask("SELECT count(*) FROM run"), 1);
  EXPECT_EQ(ask("SELECT count(*) FROM tick"), 1);
}

TEST_F(SchemaTest, ADatabaseOfTheVersionBeforeLayersIsRefusedToo) {
  {
    RunStore store(path);
    record(store, 3);
  }
  Connection(path, Connection::Mode::Write).execute("PRAGMA user_version = 4");
  EXPECT_THAT(refusal([&] { const RunReader reader(path); }), HasSubstr("has version 4"));
  EXPECT_THAT(refusal([&] { const RunStore store(path); }), HasSubstr("has version 4"));
  EXPECT_EQ(ask("SELECT sum(ticks) FROM run"), 3);
}

// Takes away what version 9 added.
constexpr const char* kBackToVersion8 = R"(
  DROP TRIGGER run_begins; DROP TRIGGER run_changes; DROP TRIGGER run_goes;
  DROP VIEW listed; DROP TABLE listing; DROP INDEX run_by_batch; DROP INDEX run_by_trash;
  ALTER TABLE run DROP COLUMN trashed; ALTER TABLE run DROP COLUMN tags;
  ALTER TABLE run DROP COLUMN note; ALTER TABLE run DROP COLUMN label;
  ALTER TABLE run DROP COLUMN last_reason; ALTER TABLE run DROP COLUMN last_outcome;
  ALTER TABLE run DROP COLUMN batch; ALTER TABLE run DROP COLUMN kind;
  CREATE INDEX run_by_scenario ON run (scenario, id);
  PRAGMA user_version = 8;
)";

TEST_F(SchemaTest, ADatabaseOfTheVersionBeforeIsBroughtUpToDate) {
  db::RunId live = 0;
  db::RunId headless = 0;
  {
    RunStore store(path);
    live = record(store, 3);
    db::NewRun second = what();
    second.document = R"({"pace":0})";
    headless = store.begin_run(second);
    store.end_run(headless, {.outcome = "stuck", .metrics = R"({"time":7.5})"});
    store.commit();
  }
  Connection(path, Connection::Mode::Write).execute(kBackToVersion8);
  EXPECT_THAT(refusal([&] { const RunReader reader(path); }), HasSubstr("brings it up to date"));
  EXPECT_EQ(ask("PRAGMA user_version"), 8);
  { const RunStore store(path); }
  EXPECT_EQ(ask("PRAGMA user_version"), 9);
  EXPECT_EQ(integrity(path), "ok");
  RunReader reader(path);
  EXPECT_EQ(get(reader, live).what.kind, db::RunKind::Session);
  EXPECT_EQ(read_frames(reader, live).size(), 3U);
  EXPECT_EQ(get(reader, headless).what.kind, db::RunKind::Background);
  EXPECT_EQ(get(reader, headless).verdict_time, 7.5);
  EXPECT_EQ(reader.list({.words = {"case1"}}, 9).runs.size(), 2U);
}

TEST_F(SchemaTest, AnEmptyFileIsSetUp) {
  { const RunStore store(path); }
  EXPECT_EQ(ask("PRAGMA user_version"), 9);
  EXPECT_EQ(ask("SELECT count(*) FROM sqlite_master WHERE name = 'listing'"), 1);
  Connection((folder / "empty.db").string(), Connection::Mode::Write);
  EXPECT_THAT(refusal([&] { const RunReader reader((folder / "empty.db").string()); }),
              HasSubstr("is empty"));
}

TEST_F(SchemaTest, ANewerDatabaseIsRefusedUntouched) {
  {
    RunStore store(path);
    record(store, 1);
  }
  Connection(path, Connection::Mode::Write).execute("PRAGMA user_version = 99");
  EXPECT_THAT(refusal([&] { const RunStore store(path); }), HasSubstr("newer program"));
  EXPECT_THAT(refusal([&] { const RunReader reader(path); }), HasSubstr("newer program"));
  EXPECT_EQ(ask("PRAGMA user_version"), 99);
  EXPECT_EQ(ask("SELECT count(*) FROM run"), 1);
}

TEST_F(SchemaTest, AnotherProgramsDatabaseIsRefusedUntouched) {
  Connection(path, Connection::Mode::Write).execute("CREATE TABLE bookmark (url TEXT)");
  const std::string before = bytes();
  EXPECT_THAT(refusal([&] { const RunStore store(path); }), HasSubstr("another program"));
  EXPECT_EQ(bytes(), before);
  // One that is damaged is no store of ours either.
  Connection(path, Connection::Mode::Write).execute("INSERT INTO bookmark VALUES ('a'), ('b')");
  std::filesystem::resize_file(path, 2048);
  const std::string cut = bytes();
  EXPECT_THAT(refusal([&] { const RunStore store(path); }), HasSubstr("another program"));
  EXPECT_EQ(bytes(), cut);
}

TEST_F(SchemaTest, WritesDurably) {
  const RunStore store(path);
  const Connection other(path, Connection::Mode::Read);
  auto mode = other.prepare("PRAGMA journal_mode");
  ASSERT_TRUE(mode.step());
  EXPECT_EQ(mode.text(0), "wal");
  EXPECT_EQ(other.query_integer("PRAGMA page_size"), 4096);
}

}  // namespace
