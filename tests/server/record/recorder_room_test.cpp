// tests/server/record/recorder_room_test.cpp: which ticks are kept when room is short.
#include <algorithm>
#include <filesystem>
#include <string>
#include <system_error>

#include "tests/server/record/recorder_fixture.hpp"
#include <gmock/gmock.h>

namespace {

using db::GapCause;
using db::RunReader;
using server::Keep;
using server::Recorder;
using server::RecorderOptions;
using server::RecordKind;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::chrono::milliseconds kOften{5};

class RecorderRoomTest : public test::RecorderFiles {
 protected:
  static RecorderOptions limited(std::uint64_t bytes) {
    return {.retention_bytes = bytes, .live_span = 20, .least_span = 5, .commit_interval = kOften};
  }
  db::RunId finished(Recorder& recorder, std::uint64_t ticks) {
    const auto channel = recorder.open(what());
    push(*channel, 0, ticks);
    channel->close({.outcome = "reached"}, ticks);
    recorder.flush();
    return channel->run();
  }
  static std::uint64_t used(Recorder& recorder) {
    return recorder.ask([](db::RunStore& store) { return store.used_bytes(); });
  }
  std::int64_t count(const std::string& what_to_count) {
    return db::detail::Connection(path, db::detail::Connection::Mode::Read)
        .query_integer("SELECT " + what_to_count);
  }
};

TEST_F(RecorderRoomTest, ALiveRunDropsItsOwnOldestTicksAndNoOtherRun) {
  constexpr std::uint64_t kTicks = 4000;  // 104 s, of which 20 s are to stay
  Recorder recorder(path, limited(0));
  const db::RunId old = finished(recorder, 300);
  const auto live = recorder.begin(what("demo"));
  push(*live, 0, kTicks);
  ASSERT_TRUE(comes([&] { return recorder.status().kept_from > 80; }));
  EXPECT_EQ(recorder.status().kind, RecordKind::Recording);
  EXPECT_THAT(recorder.status().sentence, HasSubstr("newest"));
  EXPECT_THAT(recorder.status().deleted, HasSubstr("first 1 min of this run"));
  live->close({.outcome = "stopped"}, kTicks);
  recorder.flush();

  RunReader reader(path);
  expect_frames(old, 300);
  const db::RunRow run = get(reader, live->run());
  ASSERT_EQ(run.gaps.size(), 1u);
  EXPECT_EQ(run.gaps[0].cause, GapCause::Dropped);
  const std::uint64_t first = run.gaps[0].last_tick + 1;
  EXPECT_EQ(run.gaps[0].first_tick, 0u);
  EXPECT_EQ(run.ticks, kTicks - first);
  EXPECT_GT(run.ticks, 20 / 0.026);        // the span, and
  EXPECT_LT(run.ticks, 20 / 0.026 + 600);  // the remainder of blocks and slices
  EXPECT_EQ(run.lost_ticks, 0u);
  std::uint64_t oldest = 0;
  reader.frames(
      run.id, 0, 1, [&](std::uint64_t tick, std::span<const std::byte>) { oldest = tick; });
  EXPECT_EQ(oldest, first);
  const auto frames = read_frames(reader, run.id, 0, 1000);
  ASSERT_EQ(frames.size(), run.ticks);
  EXPECT_EQ(frames.front(), made[first % made.size()].bytes);
  const std::string of_run = " WHERE run = " + std::to_string(run.id);
  EXPECT_EQ(count("sum(last_tick - first_tick + 1) FROM block" + of_run),
            static_cast<std::int64_t>(run.ticks));
  EXPECT_EQ(count("sum(length(frames)) FROM block" + of_run), static_cast<std::int64_t>(run.bytes));
}

/// A disk that holds the store's files and nothing else.
class SmallDisk {
 public:
  static constexpr std::uint64_t kBytes = 8 << 20;
  static std::uint64_t taken(const std::string& file) {
    std::uint64_t bytes = 0;
    for (const char* part : {"", "-wal", "-shm"}) {
      std::error_code error;
      const auto size = std::filesystem::file_size(file + part, error);
      if (!error) bytes += size;
    }
    return bytes;
  }
  static server::DiskSpace space(const std::string& file) {
    return {.free = kBytes - std::min(kBytes, taken(file)), .total = kBytes};
  }
};

TEST_F(RecorderRoomTest, ASmallDiskIsNotFilledByALiveRun) {
  RecorderOptions options = limited(0);
  options.live_span = 1e9;
  options.disk = &SmallDisk::space;
  Recorder recorder(path, std::move(options));
  const auto live = recorder.begin(what("demo"));
  std::uint64_t tick = 0;
  for (; recorder.status().kept_from == 0 || tick % 20'000 != 0; ++tick) {
    ASSERT_LT(tick, 1'000'000U);
    push(*live, tick);
    if (tick % 100 == 0) {
      ASSERT_LT(SmallDisk::taken(path), SmallDisk::kBytes) << tick;
    }
  }
  EXPECT_EQ(recorder.status().kind, RecordKind::Recording) << recorder.status().sentence;
  EXPECT_THAT(recorder.status().sentence, HasSubstr("no room for more"));
  EXPECT_FALSE(live->failed());
}

TEST_F(RecorderRoomTest, AMachineTooSlowToMakeRoomInTimeDoesNotFillTheDisk) {
  RecorderOptions options = limited(0);
  options.live_span = 1e9;
  std::atomic<int> looks{0};
  options.disk = [&](const std::string& file) {
    const server::DiskSpace space = SmallDisk::space(file);
    if (space.free < SmallDisk::kBytes / 4) {  // from here on room is short
      ++looks;
      std::this_thread::sleep_for(std::chrono::milliseconds(410));  // all the time there is for it
    }
    return space;
  };
  Recorder recorder(path, std::move(options));
  const auto live = recorder.begin(what("demo"));
  std::uint64_t most = 0;
  for (std::uint64_t tick = 0; looks < 15; ++tick) {
    push(*live, tick);
    if (tick % 100 == 0) most = std::max(most, SmallDisk::taken(path));
  }
  EXPECT_LT(most, SmallDisk::kBytes);
  EXPECT_GT(recorder.status().kept_from, 0);
  EXPECT_FALSE(live->failed());
}

TEST_F(RecorderRoomTest, ALiveRunFitsIntoTheRemainingRoom) {
  constexpr std::uint64_t kLimit = 6'000'000;
  RecorderOptions options = limited(kLimit);
  options.live_span = 1e9;  // more than there is room for
  Recorder recorder(path, std::move(options));
  std::vector<db::RunId> kept;
  while (used(recorder) < kLimit / 2) kept.push_back(finished(recorder, 500));
  const auto live = recorder.begin(what("demo"));
  std::uint64_t tick = 0;
  for (; tick < 20'000; tick += 200) {
    push(*live, tick, tick + 200);
    recorder.flush();
  }
  EXPECT_TRUE(comes([&] { return used(recorder) <= kLimit; }));
  EXPECT_EQ(recorder.status().kind, RecordKind::Recording);
  EXPECT_FALSE(live->failed());
  live->close({.outcome = "stopped"}, tick);
  recorder.flush();
  EXPECT_THAT(causes(live->run()), ElementsAre(GapCause::Dropped));
  for (const db::RunId run : kept) expect_frames(run, 500);
}

TEST_F(RecorderRoomTest, AStoreFullOfFinishedRunsStopsRecordingAndSaysSo) {
  constexpr std::uint64_t kLimit = 2'000'000;
  Recorder recorder(path, limited(kLimit));
  std::vector<db::RunId> kept;
  for (int i = 0; i < 200 && recorder.takes_more(); ++i) {
    const auto live = recorder.begin(what());
    push(*live, 0, 150);
    live->close({.outcome = "reached"}, 150);
    recorder.flush();
    kept.push_back(live->run());
    std::this_thread::sleep_for(2 * kOften);
  }
  ASSERT_TRUE(comes([&] { return !recorder.takes_more(); }));
  const auto live = recorder.begin(what());
  push(*live, 0, 2000);  // without waiting
  ASSERT_TRUE(comes([&] { return recorder.status().kind == RecordKind::Full; }));
  EXPECT_TRUE(live->failed());
  EXPECT_THAT(live->problem(), HasSubstr("never deleted unasked"));
  EXPECT_THAT(recorder.status().sentence, HasSubstr("--evict oldest"));
  EXPECT_TRUE(tells(recorder, "The record is full"));
  {
    RunReader reader(path);
    for (const db::RunId run : kept) EXPECT_TRUE(reader.exists(run)) << run;
  }

  // With new room the record goes on, and reports the missing ticks.
  for (std::size_t i = 0; i < kept.size() / 2; ++i) {
    recorder.ask([&](db::RunStore& store) { return store.delete_run(kept[i]); });
  }
  ASSERT_TRUE(comes([&] { return recorder.takes_more(); }));
  EXPECT_FALSE(live->failed());
  push(*live, 2000, 2100);
  live->close({.outcome = "reached"}, 2100);
  recorder.flush();
  RunReader reader(path);
  const db::RunRow run = get(reader, live->run());
  ASSERT_THAT(causes(run.id), ElementsAre(GapCause::Full));
  EXPECT_EQ(run.gaps[0].last_tick, 1999u);
  EXPECT_EQ(run.lost_ticks, 2000u);
  EXPECT_EQ(run.ticks, 100u);
}

/// Each flush commits. The time of the next look at the room must not move with it.
TEST_F(RecorderRoomTest, ManyShortRunsDoNotPostponeTheLookAtTheRoom) {
  constexpr std::uint64_t kLimit = 4'000'000;
  RecorderOptions options = limited(kLimit);
  options.commit_interval = std::chrono::milliseconds(100);  // longer than a run with its flush
  Recorder recorder(path, std::move(options));
  for (int i = 0; i < 4000 && recorder.takes_more(); ++i) finished(recorder, 20);
  EXPECT_FALSE(recorder.takes_more());
  EXPECT_LT(used(recorder), 2 * kLimit);
}

TEST_F(RecorderRoomTest, ARunToBeKeptWholeWaitsForRoom) {
  constexpr std::uint64_t kLimit = 1'500'000;
  RecorderOptions options = limited(kLimit);
  options.ring_frames = 64;
  Recorder recorder(path, std::move(options));
  const db::RunId old = finished(recorder, 3000);  // more room than the fast run needs
  const auto whole = recorder.open(what());
  std::uint64_t tick = 0;
  server::FrameHandle frame = handle(tick);
  while (recorder.takes_more()) {
    if (whole->push(frame)) frame = handle(++tick);
  }
  while (whole->push(frame)) frame = handle(++tick);  // until the ring is full
  EXPECT_TRUE(whole->failed());
  recorder.ask([&](db::RunStore& store) { return store.delete_run(old); });
  while (frame && !whole->push(frame)) std::this_thread::yield();
  whole->close({.outcome = "reached"}, tick + 1);
  EXPECT_TRUE(recorder.flush(std::chrono::seconds(30)));
  expect_frames(whole->run(), tick + 1);
  EXPECT_THAT(causes(whole->run()), IsEmpty());
}

TEST_F(RecorderRoomTest, TheOldestRunsAreDeletedOnRequest) {
  constexpr std::uint64_t kLimit = 2'000'000;
  RecorderOptions options = limited(kLimit);
  options.evict_oldest = true;
  Recorder recorder(path, std::move(options));
  std::vector<db::RunId> runs;
  for (int i = 0; i < 24; ++i) runs.push_back(finished(recorder, 1000));
  ASSERT_TRUE(comes([&] { return used(recorder) <= kLimit; }));
  RunReader reader(path);
  EXPECT_FALSE(reader.exists(runs.front()));
  EXPECT_TRUE(reader.exists(runs.back()));
  expect_frames(runs.back(), 1000);
  EXPECT_THAT(recorder.status().deleted, HasSubstr("--evict oldest"));
  EXPECT_TRUE(tells(recorder, "Deleted run 1 (case1, 2026-11-21T10:40:47Z, 1000 ticks)"));
}

TEST_F(RecorderRoomTest, SomeDiskSpaceIsLeftFree) {
  std::atomic<std::uint64_t> free = 100 << 20;
  RecorderOptions options = limited(0);
  options.disk = [&](const std::string&) {
    return server::DiskSpace{.free = free, .total = 80 << 20};  // 10 MB are left free
  };
  Recorder recorder(path, std::move(options));
  const auto live = recorder.begin(what());
  push(*live, 0, 10);
  ASSERT_TRUE(comes([&] { return recorder.status().bytes > 0; }));
  free = 9 << 20;
  ASSERT_TRUE(comes([&] { return recorder.status().kind == RecordKind::Full; }));
  EXPECT_THAT(recorder.status().sentence, HasSubstr("disk"));
  free = 100 << 20;
  ASSERT_TRUE(comes([&] { return recorder.status().kind == RecordKind::Recording; }));
}

}  // namespace
