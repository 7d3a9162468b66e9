// tests/db/run_store_test.cpp: recorded runs read back, despite failures in between.
#include "db/run_store.hpp"

#include <atomic>
#include <fstream>
#include <thread>

#include "tests/db/store_files.hpp"
#include <gmock/gmock.h>

namespace {

using db::RunReader;
using db::RunStatus;
using db::RunStore;
using test::refusal;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class RunStoreTest : public test::StoreFiles {};

TEST_F(RunStoreTest, ARunComesBackAsItWasRecorded) {
  RunStore store(path);
  const auto made = frames(150);
  const db::RunId run = store.begin_run(what());
  for (std::size_t i = 0; i < made.size(); ++i) {
    append(store, run, i, made[i]);
    if (i % 38 == 37) store.commit();
  }
  store.end_run(run,
                {.status = RunStatus::Finished,
                 .outcome = "reached",
                 .reason = "Within 0.1 m of the goal.",
                 .metrics = R"({"time":3.9})",
                 .lost_ticks = 2});
  store.commit();

  RunReader reader(path);
  const db::RunRow row_read = get(reader, run);
  EXPECT_EQ(row_read.status, RunStatus::Finished);
  EXPECT_EQ(row_read.outcome, "reached");
  EXPECT_EQ(row_read.reason, "Within 0.1 m of the goal.");
  EXPECT_EQ(row_read.metrics, R"({"time":3.9})");
  EXPECT_EQ(row_read.ticks, 150U);
  EXPECT_EQ(row_read.time, 0.026 * 149);
  EXPECT_EQ(row_read.lost_ticks, 2U);
  EXPECT_EQ(row_read.what.seed, 0xFFFFFFFFFFFFFFF1ULL);
  EXPECT_EQ(row_read.what.document, R"({"name":"case1"})");
  EXPECT_EQ(row_read.what.parameters, R"({"k_r":0.6})");
  EXPECT_EQ(row_read.what.started, "2026-11-21T10:40:47Z");

  const auto frames_read = read_frames(reader, run);
  ASSERT_EQ(frames_read.size(), made.size());
  std::size_t raw = 0;
  for (std::size_t i = 0; i < made.size(); ++i) {
    EXPECT_EQ(frames_read[i], made[i].bytes) << i;
    raw += made[i].bytes.size();
  }
  EXPECT_LT(row_read.bytes, raw / 2);
  EXPECT_GT(row_read.bytes, 150U * 223U);  // the noise of the scans is a lower bound
}

TEST_F(RunStoreTest, ShortBlocksGrowFromCommitToCommit) {
  RunStore store(path);
  const auto made = frames(300);
  const db::RunId run = store.begin_run(what());
  RunReader reader(path);
  for (std::size_t i = 0; i < made.size(); ++i) {
    append(store, run, i, made[i]);
    if (i % 10 != 9) continue;
    store.commit();
    // A reader that pages along sees every committed frame, also of a block that grew.
    EXPECT_EQ(read_frames(reader, run, i - 5).size(), 6U);
  }
  store.end_run(run, {});
  store.commit();
  // 300 frames in blocks of 70 (the first commit at or beyond 64): 70, 140, 210, 280, 300.
  db::detail::Connection connection(path, db::detail::Connection::Mode::Read);
  EXPECT_EQ(connection.query_integer("SELECT count(*) FROM block"), 5);
  EXPECT_EQ(connection.query_integer("SELECT sum(length(frames)) FROM block"),
            static_cast<std::int64_t>(get(reader, run).bytes));
}

TEST_F(RunStoreTest, LostTicksLeaveAGapAndNothingElse) {
  RunStore store(path);
  const auto made = frames(6);
  const db::RunId run = store.begin_run(what());
  for (const std::uint64_t tick : {3U, 4U, 7U, 8U, 20U}) append(store, run, tick, made[tick % 6]);
  store.commit();
  RunReader reader(path);
  std::vector<std::uint64_t> seen;
  const auto note = [&](std::uint64_t tick, std::span<const std::byte> bytes) {
    seen.push_back(tick);
    EXPECT_TRUE(std::ranges::equal(bytes, made[tick % 6].bytes));
  };
  EXPECT_EQ(reader.frames(run, 0, 3, note), 8U);
  EXPECT_EQ(reader.frames(run, 8, 3, note), std::nullopt);
  EXPECT_THAT(seen, ElementsAre(3, 4, 7, 8, 20));
  seen.clear();
  EXPECT_EQ(reader.frames(run, 9, 9, note), std::nullopt);
  EXPECT_THAT(seen, ElementsAre(20));
  EXPECT_EQ(reader.frames(run, 21, 9, note), std::nullopt);
  EXPECT_EQ(reader.frames(run + 1, 0, 9, note), std::nullopt);
  EXPECT_THAT(seen, ElementsAre(20));
  EXPECT_EQ(get(reader, run).ticks, 5U);
}

TEST_F(RunStoreTest, RefusesWhatMakesNoSense) {
  RunStore store(path);
  const db::RunId run = store.begin_run(what());
  const auto made = frames(1);
  append(store, run, 5, made[0]);
  EXPECT_THAT(refusal([&] { append(store, run, 5, made[0]); }),
              HasSubstr("does not follow tick 5"));
  EXPECT_THAT(refusal([&] { append(store, run + 1, 6, made[0]); }),
              HasSubstr("is not being recorded"));
  EXPECT_THAT(refusal([&] {
                store.append_tick(run,
                                  6,
                                  time_of(6),
                                  made[0].bytes,
                                  std::vector<db::Window>{{.offset = 60'000, .count = 1}});
              }),
              HasSubstr("tick 6: frame 1 of the block: a window reaches beyond"));
  EXPECT_THAT(refusal([&] { store.start_run(run, ""); }), HasSubstr("not waiting"));
  EXPECT_THAT(refusal([&] { store.end_run(run + 1, {}); }), HasSubstr("missing"));
  EXPECT_THAT(refusal([&] { store.end_run(run, {.status = RunStatus::Queued}); }),
              HasSubstr("queued"));
  EXPECT_THAT(refusal([&] { store.set_result(99, {}); }), HasSubstr("no run 99"));
  // None of them harmed the run.
  append(store, run, 6, made[0]);
  store.end_run(run, {});
  EXPECT_THAT(refusal([&] { store.end_run(run, {}); }), HasSubstr("finished"));
  store.commit();
  RunReader reader(path);
  EXPECT_EQ(read_frames(reader, run).size(), 2U);
}

TEST_F(RunStoreTest, QueuedRunsStartLaterOrAreCancelled) {
  RunStore store(path);
  const db::RunId first = store.queue_run(what());
  const db::RunId second = store.queue_run(what());
  store.commit();
  RunReader reader(path);
  EXPECT_EQ(get(reader, first).status, RunStatus::Queued);
  store.start_run(first, "2026-11-21T11:00:00Z");
  append(store, first, 0, frames(1)[0]);
  store.set_result(first, {.outcome = "running", .metrics = R"({"path_length":0.1})"});
  store.end_run(second, {.status = RunStatus::Cancelled, .outcome = "stopped"});
  store.commit();
  EXPECT_EQ(get(reader, first).status, RunStatus::Recording);
  EXPECT_EQ(get(reader, first).what.started, "2026-11-21T11:00:00Z");
  EXPECT_EQ(get(reader, first).metrics, R"({"path_length":0.1})");
  EXPECT_EQ(get(reader, second).status, RunStatus::Cancelled);
}

TEST_F(RunStoreTest, EqualDocumentsAreKeptOnceUntilTheLastRunWithThemIsGone) {
  RunStore store(path);
  db::NewRun big = what();
  big.document = '"' + std::string(100'000, 'x') + '"';
  const db::RunId first = store.queue_run(big);
  const std::uint64_t one = [&] {
    store.commit();
    return store.used_bytes();
  }();
  const db::RunId second = store.queue_run(big);
  const db::RunId third = store.queue_run(big);
  store.commit();
  EXPECT_LT(store.used_bytes(), one + 50'000);

  const auto remove = [&](db::RunId run) {
    store.end_run(run, {.status = db::RunStatus::Cancelled, .outcome = "stopped"});
    EXPECT_EQ(store.delete_run(run), RunStore::Deletion::Deleted);
    while (store.sweep()) {
    }
  };
  RunReader reader(path);
  EXPECT_EQ(reader.get(third)->what.document, big.document);
  remove(first);
  EXPECT_EQ(reader.get(second)->what.document, big.document);
  EXPECT_EQ(reader.get(third)->what.document, big.document);
  remove(third);
  EXPECT_EQ(reader.get(second)->what.document, big.document);
  remove(second);
  store.commit();
  EXPECT_LT(store.used_bytes(), one - 90'000);
}

TEST_F(RunStoreTest, UnfinishedRunsAreInterruptedAtTheNextStart) {
  db::RunId queued = 0;
  db::RunId recording = 0;
  db::RunId finished = 0;
  {
    RunStore store(path);
    finished = record(store, 3);
    queued = store.queue_run(what());
    recording = store.begin_run(what());
    const auto made = frames(80);
    for (std::size_t i = 0; i < 70; ++i) append(store, recording, i, made[i]);
    store.commit();
    for (std::size_t i = 70; i < 80; ++i) append(store, recording, i, made[i]);  // never committed
  }
  RunStore store(path);
  EXPECT_THAT(store.interrupted(), ElementsAre(queued, recording));
  RunReader reader(path);
  const db::RunRow row_read = get(reader, recording);
  EXPECT_EQ(row_read.status, RunStatus::Interrupted);
  EXPECT_EQ(row_read.outcome, "stopped");
  EXPECT_THAT(row_read.reason, HasSubstr("in the middle"));
  EXPECT_EQ(row_read.ticks, 70U);
  EXPECT_EQ(row_read.time, 0.026 * 69);
  EXPECT_GT(row_read.bytes, 70U * 223U);
  EXPECT_EQ(read_frames(reader, recording).size(), 70U);
  EXPECT_EQ(get(reader, queued).status, RunStatus::Interrupted);
  EXPECT_THAT(get(reader, queued).reason, HasSubstr("before this run began"));
  EXPECT_EQ(get(reader, finished).status, RunStatus::Finished);
  EXPECT_FALSE(store.recording(recording));
}

TEST_F(RunStoreTest, OneWriterOnlyByWhateverName) {
  const std::string link = (folder / "link.db").string();
  const std::string twin = (folder / "twin.db").string();
  {
    const RunStore store(path);
    std::filesystem::create_symlink(path, link);
    std::filesystem::create_hard_link(path, twin);
    for (const std::string& name : {path, link, twin}) {
      EXPECT_THAT(refusal([&] { const RunStore second(name); }),
                  HasSubstr("written by another server"));
    }
  }
  std::filesystem::remove(twin);
  const RunStore store(link);
  EXPECT_THAT(refusal([&] { const RunStore second(path); }),
              HasSubstr("written by another server"));
}

TEST_F(RunStoreTest, ADroppedRunGoesOnInItsRow) {
  RunStore store(path);
  const auto made = frames(8);
  const db::RunId run = store.begin_run(what());
  for (std::size_t i = 0; i < 3; ++i) append(store, run, i, made[i]);
  store.commit();
  append(store, run, 3, made[3]);
  store.open();  // as after a failure: uncommitted frames are lost
  EXPECT_FALSE(store.recording(run));
  EXPECT_EQ(store.resume_run(run), 3U);
  EXPECT_EQ(store.resume_run(run + 1), std::nullopt);
  const db::Gap gap{3, 5, db::GapCause::Failed, "The disk was full."};
  store.note_gap(run, gap);
  append(store, run, 6, made[6]);
  append(store, run, 7, made[7]);
  store.end_run(run, {});
  store.commit();
  RunReader reader(path);
  const db::RunRow row_read = get(reader, run);
  EXPECT_THAT(row_read.gaps, ElementsAre(gap));
  EXPECT_EQ(row_read.status, RunStatus::Finished);
  EXPECT_EQ(row_read.ticks, 5U);
  EXPECT_EQ(row_read.lost_ticks, 3U);
  const auto found = read_frames(reader, run);
  ASSERT_EQ(found.size(), 5U);
  EXPECT_EQ(found[3], made[6].bytes);
}

TEST_F(RunStoreTest, NumbersAreGivenOutBeforeTheirRowsAreWritten) {
  const auto numbers = std::make_shared<db::RunNumbers>();
  {
    RunStore store(path, {.numbers = numbers});
    const db::RunId promised = numbers->take();
    const db::RunId other = record(store, 1);
    EXPECT_GT(other, promised);
    EXPECT_EQ(store.begin_run(what(), promised), promised);
    // A number used in the file is not given to another run.
    EXPECT_GT(store.begin_run(what(), other), other);
    store.commit();
  }
  RunStore store(path);
  EXPECT_EQ(record(store, 1), 4);
}

TEST_F(RunStoreTest, ACutRunIsQueuedAgainFromItsStart) {
  RunStore store(path);
  const db::RunId run = store.queue_run(what());
  store.start_run(run, "2026-11-21T11:00:00Z");
  const auto made = frames(50);
  for (std::size_t i = 0; i < 50; ++i) append(store, run, i, made[i]);
  EXPECT_FALSE(store.requeue_run(run));  // it is at work
  store.end_run(run, {.status = RunStatus::Interrupted, .outcome = "stopped"});
  store.commit();
  EXPECT_TRUE(store.requeue_run(run));
  while (store.clear_run(run, 1)) {
  }
  RunReader reader(path);
  EXPECT_EQ(get(reader, run).status, RunStatus::Queued);
  EXPECT_EQ(get(reader, run).ticks, 0U);
  EXPECT_THAT(read_frames(reader, run), IsEmpty());
  store.start_run(run, "2026-11-21T12:00:00Z");
  append(store, run, 0, made[0]);
  store.end_run(run, {.outcome = "reached"});
  store.commit();
  EXPECT_EQ(read_frames(reader, run).size(), 1U);
  EXPECT_FALSE(store.requeue_run(run));  // it is finished
}

TEST_F(RunStoreTest, SaysWhyAFileCannotBeOpened) {
  const std::string missing = (folder / "no" / "runs.db").string();
  EXPECT_THAT(refusal([&] { const RunStore store(missing); }), HasSubstr("folder is missing"));
  EXPECT_THAT(refusal([&] { const RunReader reader(missing); }), HasSubstr("no such file"));
  EXPECT_THAT(refusal([&] { const RunReader reader((folder / "no.db").string()); }),
              HasSubstr("no.db: there is no such file."));
  EXPECT_THAT(refusal([&] { const RunReader reader(folder.string()); }), HasSubstr("a folder"));

  const std::string text = (folder / "text.db").string();
  std::ofstream(text) << std::string(20'000, 'x');
  EXPECT_THAT(refusal([&] { const RunStore store(text); }), HasSubstr("not a database"));
  EXPECT_THAT(refusal([&] { const RunReader reader(text); }), HasSubstr("not a database"));
}

TEST_F(RunStoreTest, OddFileNamesWork) {
  const std::string odd = (folder / "a b?mode=ro#%41.db").string();
  db::RunId run = 0;
  {
    RunStore store(odd);
    run = record(store, 2);
  }
  EXPECT_TRUE(std::filesystem::exists(odd));
  RunReader reader(odd);
  EXPECT_EQ(read_frames(reader, run).size(), 2U);
}

TEST_F(RunStoreTest, DeletedRunsAreGoneAtOnceAndTheirIdsForEver) {
  RunStore store(path);
  const db::RunId first = record(store, 100);
  const db::RunId second = record(store, 300);  // blocks of 128, 128 and 44
  const db::RunId third = store.begin_run(what());
  store.commit();
  EXPECT_EQ(store.delete_run(third), RunStore::Deletion::StillRecording);
  EXPECT_EQ(store.delete_run(77), RunStore::Deletion::NotFound);
  store.end_run(third, {});
  EXPECT_EQ(store.delete_run(second), RunStore::Deletion::Deleted);
  EXPECT_EQ(store.delete_run(third), RunStore::Deletion::Deleted);
  EXPECT_EQ(store.delete_run(third), RunStore::Deletion::NotFound);
  store.commit();

  RunReader reader(path);
  EXPECT_FALSE(reader.get(second));
  EXPECT_EQ(reader.count({}), 1U);
  EXPECT_THAT(read_frames(reader, second), IsEmpty());
  EXPECT_EQ(read_frames(reader, first).size(), 100U);

  const std::uint64_t before = store.used_bytes();
  std::size_t slices = 1;
  while (store.sweep(1)) ++slices;
  EXPECT_EQ(slices, 4U);  // three blocks of the second, none of the third
  EXPECT_LT(store.used_bytes(), before);
  EXPECT_FALSE(store.sweep());
  EXPECT_EQ(record(store, 1), third + 1);
  EXPECT_EQ(integrity(path), "ok");
}

TEST_F(RunStoreTest, RetentionDeletesTheOldestEndedRuns) {
  RunStore store(path);
  const db::RunId live = store.begin_run(what());  // the oldest of all, but recording
  append(store, live, 0, frames(1)[0]);
  std::vector<db::RunId> runs;
  runs.reserve(5);
  for (int i = 0; i < 5; ++i) runs.push_back(record(store, 500));
  const std::uint64_t full = store.used_bytes();
  EXPECT_FALSE(store.retire_oldest(full));

  const std::uint64_t limit = full - full / 4;  // one of five equal runs is not enough
  std::vector<db::RunId> retired;
  for (;;) {
    const auto run = store.retire_oldest(limit);
    if (!run) break;
    EXPECT_EQ(run->what.scenario, "case1");
    EXPECT_EQ(run->ticks, 500U);
    EXPECT_FALSE(store.retire_oldest(limit));  // not before this one's room is back
    while (store.sweep()) {
    }
    retired.push_back(run->id);
  }
  EXPECT_THAT(retired, ElementsAre(runs[0], runs[1]));
  EXPECT_LE(store.used_bytes(), limit);
  EXPECT_TRUE(store.recording(live));

  // Even with no room at all the run being recorded stays.
  while (store.retire_oldest(0)) {
    while (store.sweep()) {
    }
  }
  RunReader reader(path);
  EXPECT_EQ(reader.count({}), 1U);
  EXPECT_EQ(get(reader, live).status, RunStatus::Recording);
}

TEST_F(RunStoreTest, AFullDiskLosesOnlyTheOpenTransaction) {
  db::RunId kept = 0;
  db::RunId cut = 0;
  {
    RunStore store(path, {.max_pages = 160});  // 640 KiB
    kept = record(store, 100);
    cut = store.begin_run(what());
    const auto made = frames(400);
    for (std::size_t i = 0; i < 100; ++i) append(store, cut, i, made[i]);
    store.commit();
    std::size_t tick = 100;
    const std::string why = refusal([&] {
      for (;; ++tick) {
        append(store, cut, tick, made[tick % 400]);
        if (tick % 200 == 199) store.commit();
      }
    });
    EXPECT_THAT(why, HasSubstr("The disk is full"));
    EXPECT_GT(tick, 200U);
    EXPECT_FALSE(store.recording(cut));
    EXPECT_THAT(refusal([&] { append(store, cut, tick, made[0]); }),
                HasSubstr("not being recorded"));

    // Deleting needs no room, and makes some.
    EXPECT_EQ(store.delete_run(kept), RunStore::Deletion::Deleted);
    while (store.sweep()) {
    }
    EXPECT_EQ(record(store, 20), cut + 1);
  }
  EXPECT_EQ(integrity(path), "ok");
  const RunStore store(path);
  EXPECT_THAT(store.interrupted(), ElementsAre(cut));
  RunReader reader(path);
  const db::RunRow row_read = get(reader, cut);
  EXPECT_EQ(row_read.ticks % 200, row_read.ticks == 100 ? 100U : 0U);  // what a commit had stored
  EXPECT_EQ(read_frames(reader, cut).size(), row_read.ticks);
  EXPECT_FALSE(reader.get(kept));
}

TEST_F(RunStoreTest, AReaderFollowsWhileTheWriterWrites) {
  RunStore store(path);
  const db::RunId run = store.begin_run(what());
  store.commit();
  const auto made = frames(97);
  std::atomic<bool> done = false;
  std::thread reading([&] {
    RunReader reader(path);
    std::uint64_t next = 0;
    while (!done || next < 3000) {
      reader.frames(run, next, 500, [&](std::uint64_t tick, std::span<const std::byte> bytes) {
        ASSERT_EQ(tick, next++);
        ASSERT_TRUE(std::ranges::equal(bytes, made[tick % 97].bytes));
      });
      ASSERT_LE(get(reader, run).ticks, 3000U);
    }
    EXPECT_EQ(next, 3000U);
  });
  for (std::uint64_t tick = 0; tick < 3000; ++tick) {
    append(store, run, tick, made[tick % 97]);
    if (tick % 101 == 0) store.commit();
  }
  store.commit();
  done = true;
  reading.join();
}

}  // namespace
