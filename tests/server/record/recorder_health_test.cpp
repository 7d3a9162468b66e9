// tests/server/record/recorder_health_test.cpp: a locked, full, deleted or damaged store loses
// ticks of the record, and nothing else.
#include <fstream>
#include <sstream>

#include "tests/server/record/recorder_fixture.hpp"
#include <gmock/gmock.h>

namespace {

using db::GapCause;
using db::RunReader;
using db::RunStatus;
using db::detail::Connection;
using server::Recorder;
using server::RecorderOptions;
using server::RecordKind;
using test::refusal;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class RecorderHealthTest : public test::RecorderFiles {
 protected:
  static RecorderOptions quick() {
    return {.retention_bytes = 0,
            .commit_interval = std::chrono::milliseconds(5),
            .retry_interval = std::chrono::milliseconds(20)};
  }
  /// Writes noise over pages `from` to `to` of the file, counted from 0.
  void spoil(std::int64_t from, std::int64_t to) const {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(from * 4096);
    for (std::int64_t i = from * 4096; i < to * 4096; ++i) {
      file.put(static_cast<char>(i * 7919 >> 3));
    }
  }
};

TEST_F(RecorderHealthTest, ALockedStoreKeepsTheFramesWaiting) {
  Recorder recorder(path, quick());
  recorder.flush();
  const Connection other(path, Connection::Mode::Write);
  other.execute("BEGIN EXCLUSIVE");
  const auto live = recorder.begin(what());  // at once, though its row cannot be written
  EXPECT_GT(live->run(), 0);
  push(*live, 0, 300);
  EXPECT_TRUE(comes([&] { return recorder.status().kind == RecordKind::Failed; }));
  EXPECT_THAT(recorder.status().sentence, HasSubstr("held by another program"));
  EXPECT_FALSE(recorder.flush(std::chrono::milliseconds(50)));
  EXPECT_FALSE(live->failed());
  other.execute("ROLLBACK");
  ASSERT_TRUE(recorder.flush(std::chrono::seconds(30)));
  live->close({.outcome = "reached"}, 300);
  ASSERT_TRUE(recorder.flush(std::chrono::seconds(30)));
  expect_frames(live->run(), 300);
  EXPECT_THAT(causes(live->run()), IsEmpty());
  EXPECT_TRUE(comes([&] { return recorder.status().kind == RecordKind::Recording; }));
}

TEST_F(RecorderHealthTest, AFullDiskLeavesAGapAndTheRunGoesOn) {
  RecorderOptions options = quick();
  options.store.max_pages = 240;
  Recorder recorder(path, std::move(options));
  const auto first = recorder.open(what());
  push(*first, 0, 500);
  first->close({.outcome = "reached"}, 500);
  recorder.flush();
  const auto live = recorder.begin(what());
  std::uint64_t tick = 0;
  push(*live, tick++);
  recorder.flush();
  for (; !live->failed(); ++tick) {
    ASSERT_LT(tick, 100'000U);
    push(*live, tick);
  }
  EXPECT_THAT(live->problem(), HasSubstr("The disk is full"));
  EXPECT_TRUE(comes([&] { return recorder.status().kind == RecordKind::Failed; }));
  for (const std::uint64_t end = tick + 3000; tick < end; ++tick) push(*live, tick);

  recorder.post_when_well([&](db::RunStore& store) { store.delete_run(first->run()); });
  recorder.post_when_well([](db::RunStore& store) {
    while (store.sweep()) {
    }
  });
  ASSERT_TRUE(comes([&] {
    push(*live, tick++);
    RunReader reader(path);
    return !reader.exists(first->run()) && recorder.status().kind == RecordKind::Recording;
  }));
  live->close({.outcome = "reached"}, tick);
  ASSERT_TRUE(comes([&] {
    recorder.flush();
    RunReader reader(path);
    return get(reader, live->run()).status == RunStatus::Finished;
  }));
  EXPECT_EQ(alive, 0);
  EXPECT_TRUE(tells(recorder, "The disk is full"));
  EXPECT_EQ(integrity(path), "ok");
  RunReader reader(path);
  const db::RunRow run = get(reader, live->run());
  EXPECT_THAT(causes(run.id), Contains(GapCause::Failed));
  EXPECT_EQ(run.ticks + run.lost_ticks, tick);
  EXPECT_EQ(read_frames(reader, run.id, 0, 1000).size(), run.ticks);
}

TEST_F(RecorderHealthTest, ManyResetsWhileTheStoreFailsLeaveNoRunWithoutItsEnd) {
  RecorderOptions options = quick();
  std::atomic<std::uint64_t> free = 100 << 20;
  options.store.max_pages = 240;
  options.disk = [&](const std::string&) {
    return server::DiskSpace{.free = free, .total = 160 << 20};
  };
  Recorder recorder(path, std::move(options));
  const auto old = recorder.open(what());
  push(*old, 0, 500);
  old->close({.outcome = "reached"}, 500);
  recorder.flush();
  const auto first = recorder.begin(what());
  std::uint64_t tick = 0;
  for (; !first->failed(); ++tick) {
    ASSERT_LT(tick, 100'000U);
    push(*first, tick);
  }
  free = 0;
  first->close({.outcome = "stopped"}, tick);
  for (int reset = 0; reset < 100; ++reset) {
    const auto next = recorder.begin(what());
    push(*next, 0);
    next->close({.outcome = "stopped"}, 1);
  }
  EXPECT_TRUE(recorder.flush());
  // Somebody else makes room: the store has none left to begin a row with.
  Connection(path, Connection::Mode::Write)
      .execute("DELETE FROM block WHERE run = " + std::to_string(old->run()));
  free = 100 << 20;
  EXPECT_TRUE(comes([&] {
    recorder.flush();
    RunReader reader(path);
    return get(reader, first->run()).status == RunStatus::Finished;
  }));
}

TEST_F(RecorderHealthTest, ADeletedFileIsCreatedAgain) {
  Recorder recorder(path, quick());
  const auto live = recorder.begin(what());
  push(*live, 0, 100);
  recorder.flush();
  RunReader reader(path);
  EXPECT_EQ(get(reader, live->run()).ticks, 100u);
  std::filesystem::remove(path);
  ASSERT_TRUE(comes([&] { return std::filesystem::exists(path); }));
  push(*live, 100, 150);
  recorder.flush();
  // The same reader sees the new file; the run has kept its number.
  const db::RunRow run = get(reader, live->run());
  EXPECT_EQ(run.ticks, 50u);
  ASSERT_THAT(causes(run.id), ElementsAre(GapCause::Failed));
  EXPECT_EQ(run.gaps[0].last_tick, 99u);
  EXPECT_TRUE(tells(recorder, "deleted or replaced"));
  EXPECT_FALSE(live->failed());
}

TEST_F(RecorderHealthTest, ADamagedStoreIsSetAsideAndTheRunGoesOnInANewOne) {
  Recorder recorder(path, quick());
  const db::RunId old = recorder.open(what())->run();
  const auto live = recorder.begin(what());
  push(*live, 0, 2000);
  recorder.flush();
  Connection(path, Connection::Mode::Write).execute("PRAGMA wal_checkpoint(TRUNCATE)");
  spoil(0, static_cast<std::int64_t>(std::filesystem::file_size(path) / 4096));
  // The store's cache would hide the damage for a while: force it to read the file.
  refusal([&] { recorder.ask([](db::RunStore& store) { store.open(); }); });
  push(*live, 2000, 2001);
  ASSERT_TRUE(tells(recorder, "set aside as"));
  ASSERT_TRUE(comes([&] { return recorder.status().kind == RecordKind::Recording; }));
  push(*live, 2001, 2100);
  live->close({.outcome = "reached"}, 2100);
  recorder.flush();
  RunReader reader(path);
  EXPECT_FALSE(reader.exists(old));
  EXPECT_GT(get(reader, live->run()).ticks, 90u);
  EXPECT_EQ(integrity(path), "ok");
  std::size_t aside = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    aside += entry.path().filename().string().starts_with("runs.damaged-") ? 1U : 0U;
  }
  EXPECT_GE(aside, 1u);
  // The sentence to users does not reveal the host's folders.
  for (const std::string& news : heard) {
    EXPECT_THAT(news, testing::Not(HasSubstr(folder.string())));
  }
}

TEST_F(RecorderHealthTest, AStoreOfAnOlderProgramIsSetAsideWhole) {
  {
    db::RunStore store(path);
    record(store, 100);
  }
  Connection(path, Connection::Mode::Write).execute("PRAGMA user_version = 4");
  {
    Recorder recorder(path, quick());
    const auto live = recorder.begin(what());
    push(*live, 0, 10);
    live->close({.outcome = "reached"}, 10);
    recorder.flush();
    expect_frames(live->run(), 10);
    EXPECT_TRUE(tells(recorder, "The older run store was set aside as"));
  }
  std::vector<std::filesystem::path> aside;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("runs.older-") && name.ends_with("Z.db")) aside.push_back(entry.path());
  }
  ASSERT_EQ(aside.size(), 1u);
  const Connection kept(aside[0].string(), Connection::Mode::Write);
  EXPECT_EQ(kept.query_integer("SELECT sum(ticks) FROM run"), 100);
  EXPECT_EQ(kept.query_integer("PRAGMA user_version"), 4);
}

TEST_F(RecorderHealthTest, ADamagedStoreIsSetAsideAtTheStartButAnotherFileIsNot) {
  {
    db::RunStore store(path);
    record(store, 100);
  }
  spoil(1, 3);
  {
    Recorder recorder(path, quick());
    const auto live = recorder.begin(what());
    push(*live, 0, 10);
    live->close({.outcome = "reached"}, 10);
    recorder.flush();
    expect_frames(live->run(), 10);
    EXPECT_TRUE(tells(recorder, "set aside as"));
  }
  const std::string other = (folder / "notes.txt").string();
  const std::string text = "Remember the milk.\n" + std::string(5000, 'x');
  for (const std::string& bytes : {text, std::string(8192, '\7'), std::string("SQLite format 3")}) {
    std::ofstream(other) << bytes;
    EXPECT_THAT(refusal([&] { const Recorder recorder(other, quick()); }),
                HasSubstr("notes.txt is not a database; choose another file"));
    std::stringstream left;
    left << std::ifstream(other).rdbuf();
    EXPECT_EQ(left.str(), bytes);
  }
}

TEST_F(RecorderHealthTest, OneDamagedOldRunDoesNotEndANewOne) {
  db::RunId old = 0;
  std::int64_t pages = 0;
  {
    db::RunStore store(path);
    old = record(store, 4800);
  }
  pages = static_cast<std::int64_t>(std::filesystem::file_size(path) / 4096);
  ASSERT_GT(pages, 200);
  spoil(50, pages - 50);
  Recorder recorder(path, quick());
  const auto live = recorder.begin(what());
  push(*live, 0, 100);
  recorder.ask([&](db::RunStore& store) { return store.delete_run(old); });
  ASSERT_TRUE(tells(recorder, "is damaged: its room"));
  push(*live, 100, 200);
  live->close({.outcome = "reached"}, 200);
  recorder.flush();
  expect_frames(live->run(), 200);
  EXPECT_THAT(causes(live->run()), IsEmpty());
}

TEST_F(RecorderHealthTest, AStoreThatIsLockedAtTheStartIsOpenedLater) {
  { const db::RunStore store(path); }
  std::optional<Connection> other(std::in_place, path, Connection::Mode::Write);
  other->execute("BEGIN EXCLUSIVE");
  Recorder recorder(path, quick());
  const auto live = recorder.begin(what());
  push(*live, 0, 50);
  other->execute("ROLLBACK");
  live->close({.outcome = "reached"}, 50);
  ASSERT_TRUE(recorder.flush(std::chrono::seconds(30)));
  RunReader reader(path);
  EXPECT_EQ(get(reader, live->run()).status, RunStatus::Finished);
}

TEST_F(RecorderHealthTest, APauseIsMarked) {
  Recorder recorder(path, quick());
  const auto live = recorder.begin(what());
  push(*live, 0, 10);
  live->pause();
  ASSERT_TRUE(comes([&] { return recorder.status().kind == RecordKind::Paused; }));
  push(*live, 500, 510);
  live->pause();
  live->close({.outcome = "reached"}, 900);
  recorder.flush();
  RunReader reader(path);
  const db::RunRow run = get(reader, live->run());
  const auto gap = [](std::uint64_t first, std::uint64_t last) {
    return db::Gap{first, last, GapCause::Pause, "Nothing happened: the record paused."};
  };
  EXPECT_THAT(run.gaps, ElementsAre(gap(10, 499), gap(510, 899)));
  EXPECT_EQ(run.lost_ticks, 0u);
  EXPECT_EQ(run.ticks, 20u);
}

TEST_F(RecorderHealthTest, AnotherNameOfTheFileIsTheSameStore) {
  const Recorder recorder(path, quick());
  const auto link = folder / "link.db";
  const auto twin = folder / "twin.db";
  std::filesystem::create_symlink(path, link);
  std::filesystem::create_hard_link(path, twin);
  for (const auto& name : {link, twin}) {
    EXPECT_THAT(refusal([&] { const Recorder second(name.string(), quick()); }),
                HasSubstr("written by another server"));
  }
}

}  // namespace
