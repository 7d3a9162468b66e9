// tests/db/run_reader_test.cpp: lists, pages, CSV and damaged blocks.
#include "db/run_reader.hpp"

#include "tests/db/store_files.hpp"
#include <gmock/gmock.h>
#include <sys/stat.h>

namespace {

using db::RunFilter;
using db::RunReader;
using db::RunStatus;
using db::RunStore;
using test::refusal;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class RunReaderTest : public test::StoreFiles {
 protected:
  static std::vector<db::RunId> ids(const db::RunPage& page) {
    std::vector<db::RunId> found;
    found.reserve(page.runs.size());
    for (const auto& run : page.runs) found.push_back(run.id);
    return found;
  }
};

TEST_F(RunReaderTest, ListsNewestFirstByPage) {
  RunStore store(path);
  std::vector<db::RunId> runs;
  runs.reserve(5);
  for (int i = 0; i < 5; ++i) runs.push_back(record(store, 1));
  RunReader reader(path);
  auto page = reader.list({}, 2);
  EXPECT_THAT(ids(page), ElementsAre(runs[4], runs[3]));
  ASSERT_TRUE(page.next);
  // A run that starts between two pages does not shift the second.
  record(store, 1);
  page = reader.list({}, 2, page.next);
  EXPECT_THAT(ids(page), ElementsAre(runs[2], runs[1]));
  page = reader.list({}, 2, page.next);
  EXPECT_THAT(ids(page), ElementsAre(runs[0]));
  EXPECT_FALSE(page.next);
  EXPECT_EQ(page.runs[0].what.document, "");
  EXPECT_FALSE(reader.list({}, 6).next);
  EXPECT_EQ(reader.count({}), 6U);
}

TEST_F(RunReaderTest, FiltersByEachColumnAndAll) {
  RunStore store(path);
  const auto a = record(store, 1, "case1", "reached");
  const auto b = record(store, 1, "case2", "stuck");
  const auto c = record(store, 1, "case1", "stuck");
  const auto d = store.queue_run(what("case1' OR 1=1 --"));
  store.commit();
  RunReader reader(path);
  EXPECT_THAT(ids(reader.list({.scenario = "case1"}, 9)), ElementsAre(c, a));
  EXPECT_THAT(ids(reader.list({.outcome = "stuck"}, 9)), ElementsAre(c, b));
  EXPECT_THAT(ids(reader.list({.status = RunStatus::Queued}, 9)), ElementsAre(d));
  EXPECT_THAT(ids(reader.list({.scenario = "case1' OR 1=1 --"}, 9)), ElementsAre(d));
  EXPECT_THAT(ids(reader.list({.controller = "modified"}, 9)), ElementsAre(d, c, b, a));
  EXPECT_THAT(ids(reader.list({.controller = "original"}, 9)), IsEmpty());
  const RunFilter all{.scenario = "case1",
                      .controller = "modified",
                      .outcome = "stuck",
                      .status = RunStatus::Finished};
  EXPECT_THAT(ids(reader.list(all, 9)), ElementsAre(c));
  EXPECT_EQ(reader.count(all), 1U);
  EXPECT_EQ(reader.count({.scenario = "case1"}), 2U);
  const auto page = reader.list({.outcome = "stuck"}, 1);
  EXPECT_THAT(ids(reader.list({.outcome = "stuck"}, 1, page.next)), ElementsAre(b));
}

TEST_F(RunReaderTest, FramesComeByPage) {
  RunStore store(path);
  const auto run = record(store, 25);
  RunReader reader(path);
  std::vector<std::uint64_t> seen;
  const auto page = [&](db::RunId of, std::uint64_t from, std::size_t limit) {
    seen.clear();
    return reader.frames(of, from, limit, [&](std::uint64_t tick, std::span<const std::byte>) {
      seen.push_back(tick);
    });
  };
  EXPECT_EQ(page(run, 3, 10), 13U);
  EXPECT_EQ(seen.front(), 3U);
  EXPECT_EQ(seen.size(), 10U);
  EXPECT_EQ(page(run, 15, 10), std::nullopt);
  EXPECT_EQ(seen.size(), 10U);
  EXPECT_EQ(page(run, 0, 0), 0U);
  EXPECT_EQ(page(run, UINT64_MAX, 10), std::nullopt);
  EXPECT_THAT(seen, IsEmpty());
  EXPECT_EQ(page(run + 1, 0, 10), std::nullopt);
  EXPECT_THAT(seen, IsEmpty());
  EXPECT_EQ(page(run, 0, SIZE_MAX), std::nullopt);
  EXPECT_EQ(seen.size(), 25U);
}

TEST_F(RunReaderTest, FramesStartAnywhere) {
  RunStore store(path);
  const auto made = frames(200);
  const auto run = record(store, 200);
  RunReader reader(path);
  for (const std::uint64_t from : {199U, 0U, 127U, 128U, 64U, 65U}) {
    const auto found = read_frames(reader, run, from, 50);
    ASSERT_EQ(found.size(), 200 - from);
    EXPECT_EQ(found.front(), made[from].bytes);
  }
  const auto none = [](std::uint64_t, std::span<const std::byte>) { FAIL(); };
  EXPECT_EQ(reader.frames(run, 5, 0, none), 5U);
}

TEST_F(RunReaderTest, ADamagedBlockIsNamed) {
  RunStore store(path);
  const auto run = record(store, 200);
  {
    db::detail::Connection other(path, db::detail::Connection::Mode::Write);
    other.execute("UPDATE block SET frames = zeroblob(100) WHERE first_tick = 128");
  }
  RunReader reader(path);
  std::size_t seen = 0;
  const std::string why = refusal([&] {
    reader.frames(run, 0, 500, [&](std::uint64_t, std::span<const std::byte>) { ++seen; });
  });
  EXPECT_EQ(seen, 128U);
  EXPECT_THAT(why, HasSubstr("Run 1 is damaged at tick 128"));
  // The ticks before it are still readable.
  EXPECT_EQ(reader.frames(run, 100, 28, [&](std::uint64_t, std::span<const std::byte>) { ++seen; }),
            128U)
      << "the page ends before the damage";
}

TEST_F(RunReaderTest, AnEmptyFileIsNoStore) {
  {
    const db::detail::Connection made(path, db::detail::Connection::Mode::Write);
    made.execute("CREATE TABLE a (b)");
  }
  EXPECT_THAT(refusal([&] { const RunReader reader(path); }), HasSubstr("another program"));
}

}  // namespace
