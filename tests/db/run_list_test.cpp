// tests/db/run_list_test.cpp: search, order, pages and groups of the list of runs.
#include <algorithm>

#include "tests/db/store_files.hpp"
#include <gmock/gmock.h>

namespace {

using db::RunFilter;
using db::RunOrder;
using db::RunReader;
using db::RunStore;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;
using testing::UnorderedElementsAre;

class RunListTest : public test::StoreFiles {
 protected:
  /// An ended run with these figures; a path below 0 is none.
  static db::RunId ended(RunStore& store,
                         const db::NewRun& what,
                         const std::string& outcome,
                         double time,
                         double path) {
    const db::RunId run = store.begin_run(what);
    const std::string length = path < 0 ? "null" : std::to_string(path);
    store.end_run(
        run,
        {.outcome = outcome,
         .metrics = R"({"time":)" + std::to_string(time) + R"(,"path_length":)" + length + "}"});
    return run;
  }
  static std::vector<db::RunId> ids(const db::RunPage& page) {
    std::vector<db::RunId> found;
    std::ranges::transform(page.runs, std::back_inserter(found), &db::RunRow::id);
    return found;
  }
  /// The whole list, read in pages of two.
  static std::vector<db::RunId> paged(RunReader& reader, const RunOrder& order) {
    std::vector<db::RunId> found;
    std::optional<std::string> cursor;
    do {
      const db::RunPage page = reader.list({}, 2, cursor, order);
      std::ranges::copy(ids(page), std::back_inserter(found));
      cursor = page.next;
    } while (cursor);
    return found;
  }
};

TEST_F(RunListTest, FindsWordsAnywhereInAnyOrder) {
  RunStore store(path);
  const auto a = record(store, 1, "case1");
  const auto b = record(store, 1, "narrow_door");
  const auto c = record(store, 1, "narrow_door", "stuck");
  ASSERT_TRUE(store.remark(a, {.label = "Slow floor", .note = "The LEFT wheel slips"}));
  ASSERT_TRUE(store.remark(c, {.tags = {{"wet", "left turn"}}}));
  store.commit();
  RunReader reader(path);
  const auto find = [&](std::vector<std::string> words) {
    return ids(reader.list({.words = std::move(words)}, 9));
  };
  EXPECT_THAT(find({"door"}), ElementsAre(c, b));
  EXPECT_THAT(find({"left"}), ElementsAre(c, a));
  EXPECT_THAT(find({"left", "slow"}), ElementsAre(a));
  EXPECT_THAT(find({"slow", "left"}), ElementsAre(a));
  EXPECT_THAT(find({"door", "wet"}), ElementsAre(c));
  EXPECT_THAT(find({std::to_string(b), "door"}), ElementsAre(b));
  EXPECT_THAT(find({"%"}), IsEmpty());
  EXPECT_THAT(ids(reader.list({.tag = "wet"}, 9)), ElementsAre(c));
  EXPECT_THAT(ids(reader.list({.tag = "left"}, 9)), IsEmpty());
  EXPECT_EQ(get(reader, c).tags, (std::vector<std::string>{"wet", "left turn"}));
  // The chips count what the search finds, whatever outcome is picked.
  const RunFilter doors{.outcome = "stuck", .words = {"door"}};
  EXPECT_EQ(reader.count(doors), 1U);
  EXPECT_THAT(reader.results(doors), UnorderedElementsAre(Pair("reached", 1), Pair("stuck", 1)));
}

TEST_F(RunListTest, SortsByFiguresWithUnknownOnesLast) {
  RunStore store(path);
  const auto a = ended(store, what("b"), "reached", 30, 5);
  const auto b = ended(store, what("a"), "stuck", 10, -1);
  const auto c = ended(store, what("c"), "reached", 20, 7);
  const auto d = ended(store, what("a"), "reached", 20, 5);
  store.commit();
  RunReader reader(path);
  const auto by = [&](const std::string& name, bool descending) {
    return paged(reader, {.by = name, .descending = descending});
  };
  EXPECT_THAT(by("path_length", true), ElementsAre(c, d, a, b));
  EXPECT_THAT(by("path_length", false), ElementsAre(a, d, c, b));
  EXPECT_THAT(by("time", true), ElementsAre(a, d, c, b));
  EXPECT_THAT(by("scenario", false), ElementsAre(b, d, a, c));
  EXPECT_THAT(by("outcome", true), ElementsAre(b, d, c, a));
  EXPECT_THAT(by("id", false), ElementsAre(a, b, c, d));
  for (const std::string_view name : db::sort_names()) {
    for (const bool descending : {false, true}) {
      const RunOrder order{.by = std::string(name), .descending = descending};
      EXPECT_EQ(paged(reader, order), ids(reader.list({}, 9, {}, order))) << name;
    }
  }
  EXPECT_THROW(reader.list({}, 9, {}, {.by = "colour"}), std::invalid_argument);
  EXPECT_THROW(reader.list({}, 9, "x:1", {.by = "time"}), std::invalid_argument);
  EXPECT_THROW(reader.list({}, 9, "3", {.by = "time"}), std::invalid_argument);
}

TEST_F(RunListTest, APageEndsWhenItsRoomIsFull) {
  RunStore store(path);
  const auto a = record(store, 1);
  const auto b = record(store, 1);
  RunReader reader(path);
  const db::RunPage page = reader.list({}, 9, {}, {}, 1);
  EXPECT_THAT(ids(page), ElementsAre(b));
  EXPECT_THAT(ids(reader.list({}, 9, page.next, {}, 1)), ElementsAre(a));
}

TEST_F(RunListTest, ABatchIsOneLineWithItsCounts) {
  RunStore store(path);
  const auto alone = record(store, 1);
  db::NewRun one = what("case2");
  one.batch = db::kNewBatch;
  const auto first = ended(store, one, "reached", 9, 1);
  one.batch = first;
  const auto second = ended(store, one, "stuck", 8, 2);
  const auto third = store.queue_run(one);
  const auto last = record(store, 1);
  store.commit();
  RunReader reader(path);
  EXPECT_EQ(get(reader, first).what.batch, first);
  EXPECT_EQ(get(reader, alone).what.batch, 0);
  const RunOrder grouped{.grouped = true};
  const db::RunPage page = reader.list({}, 9, {}, grouped);
  EXPECT_THAT(ids(page), ElementsAre(last, third, alone));
  ASSERT_TRUE(page.runs[1].group);
  EXPECT_FALSE(page.runs[0].group);
  EXPECT_EQ(page.runs[1].group->runs, 3U);
  EXPECT_EQ(page.runs[1].group->first, first);
  EXPECT_THAT(page.runs[1].group->counts,
              UnorderedElementsAre(Pair("reached", 1), Pair("stuck", 1), Pair("queued", 1)));
  EXPECT_EQ(reader.count({}, true), 3U);
  EXPECT_EQ(reader.count({}), 5U);
  EXPECT_THAT(paged(reader, grouped), ElementsAre(last, third, alone));
  // A search looks at each run of the batch.
  const db::RunPage found = reader.list({.outcome = "stuck"}, 9, {}, grouped);
  EXPECT_THAT(ids(found), ElementsAre(second));
  EXPECT_EQ(found.runs[0].group->runs, 1U);
  EXPECT_THAT(ids(reader.list({.batch = first}, 9)), ElementsAre(third, second, first));
  EXPECT_THAT(store.runs_of_batch(first), ElementsAre(first, second, third));
}

TEST_F(RunListTest, TheResultIsTheVerdictOrTheStatus) {
  RunStore store(path);
  const auto queued = store.queue_run(what());
  const auto cancelled = store.queue_run(what());
  store.end_run(cancelled, {.status = db::RunStatus::Cancelled, .outcome = "stopped"});
  const auto live = store.begin_run(what());
  store.set_result(live,
                   {.outcome = "stuck", .metrics = R"({"time":86})", .last_outcome = "running"});
  store.commit();
  RunReader reader(path);
  EXPECT_EQ(get(reader, queued).result, "queued");
  EXPECT_EQ(get(reader, cancelled).result, "cancelled");
  EXPECT_EQ(get(reader, live).result, "stuck");
  EXPECT_EQ(get(reader, live).verdict_time, 86);
  EXPECT_EQ(get(reader, live).last_outcome, "running");
  EXPECT_THAT(ids(reader.list({.result = "queued"}, 9)), ElementsAre(queued));
  store.end_run(live, {.outcome = "stuck", .metrics = R"({"time":86})", .last_outcome = "reached"});
  store.commit();
  EXPECT_EQ(get(reader, live).outcome, "stuck");
  EXPECT_EQ(get(reader, live).last_outcome, "reached");
}

TEST_F(RunListTest, ATrashedRunComesBackUntilTheTrashIsEmptied) {
  RunStore store(path);
  const auto a = record(store, 3);
  const auto b = record(store, 3);
  const auto running = store.begin_run(what());
  EXPECT_EQ(store.trash(a, 100), RunStore::Deletion::Deleted);
  EXPECT_EQ(store.trash(a, 100), RunStore::Deletion::NotFound);
  EXPECT_EQ(store.trash(b, 200), RunStore::Deletion::Deleted);
  EXPECT_EQ(store.trash(running, 200), RunStore::Deletion::StillRecording);
  EXPECT_EQ(store.trash(99, 200), RunStore::Deletion::NotFound);
  store.commit();
  RunReader reader(path);
  EXPECT_THAT(ids(reader.list({}, 9)), ElementsAre(running));
  EXPECT_FALSE(reader.get(a));
  EXPECT_FALSE(reader.exists(a));
  EXPECT_FALSE(store.remark(a, {.label = "x"}));
  EXPECT_FALSE(store.sweep());  // the trash keeps its room
  EXPECT_TRUE(store.restore(a));
  EXPECT_FALSE(store.restore(a));
  store.commit();
  EXPECT_EQ(read_frames(reader, a).size(), 3U);
  EXPECT_EQ(store.empty_trash(199, 10), 0U);
  EXPECT_EQ(store.empty_trash(200, 10), 1U);
  store.commit();
  EXPECT_FALSE(store.restore(b));
  store.sweep();
  EXPECT_EQ(reader.count({}), 2U);
}

TEST_F(RunListTest, TagsAreAddedOnceAndRemoved) {
  RunStore store(path);
  const auto run = record(store, 1);
  const std::vector<std::string> two{"wet", "slow"};
  const std::vector<std::string> none;
  EXPECT_TRUE(store.change_tags(run, two, none));
  EXPECT_TRUE(store.change_tags(run, two, std::vector<std::string>{"wet"}));
  store.commit();
  RunReader reader(path);
  EXPECT_EQ(get(reader, run).tags, (std::vector<std::string>{"slow", "wet"}));
  EXPECT_FALSE(store.change_tags(99, two, none));
}

}  // namespace
