// tests/db/run_list_load_test.cpp: how long a list, a search and an order of 20,000 runs take. It
// reports the figures and limits none of them. With TAUTLINE_FILL=FILE the store is kept as FILE,
// for tests/dev/runs_load.mjs.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <random>

#include "tests/db/store_files.hpp"

namespace {

using db::RunFilter;
using db::RunOrder;

constexpr std::size_t kRuns = 20'000;
constexpr std::size_t kBatch = 25;  // runs; every other batch
constexpr int kTimes = 100;

class RunListLoadTest : public test::StoreFiles {
 protected:
  template <typename T, std::size_t N>
  const T& any(const std::array<T, N>& of) {
    return of[random_() % N];
  }
  double figure(double most) { return std::uniform_real_distribution<>(0, most)(random_); }

  void fill(const std::string& file) {
    static const std::array<std::string, 5> kScenarios{
        "case1", "case3", "demo", "bottleneck_0_9", "barn_141"};
    static const std::array<std::string, 4> kControllers{"modified", "original", "dwa", "vfh"};
    static const std::array<std::string, 5> kOutcomes{
        "reached", "reached", "reached", "stuck", "collided"};
    db::RunStore store(file);
    db::RunId batch = 0;
    for (std::size_t i = 0; i < kRuns; ++i) {
      db::NewRun run = what(any(kScenarios));
      run.controller = any(kControllers);
      run.seed = i;
      run.kind = i % 7 == 0 ? db::RunKind::Session : db::RunKind::Background;
      const bool batched = i / kBatch % 2 == 1;
      run.batch = !batched ? 0 : i % kBatch == 0 ? db::kNewBatch : batch;
      const db::RunId id = store.begin_run(run);
      if (run.batch == db::kNewBatch) batch = id;
      const std::string outcome = any(kOutcomes);
      std::array<char, 400> metrics{};
      std::snprintf(
          metrics.data(),
          metrics.size(),
          R"({"collided":false,"infringed_time":0.0,"intrusion":%.6f,"min_clearance":%.6f,)"
          R"("outcome":"%s","path_length":%.6f,"ticks":2300,"time":%.3f,"turning":%.6f,)"
          R"("via_points":4})",
          figure(0.5),
          figure(1),
          outcome.c_str(),
          5 + figure(5),
          40 + figure(60),
          figure(8));
      store.end_run(id, {.outcome = outcome, .metrics = metrics.data()});
      if (i % 50 == 0) store.remark(id, {.label = "Wet floor " + std::to_string(i / 50)});
      if (i % 40 == 0) store.remark(id, {.note = "The left wheel slips.", .tags = {{"wet"}}});
      if (i % 1000 == 0) store.commit();
    }
    store.commit();
  }

  /// Prints the median and the 99th of kTimes times of `act`.
  template <typename Act>
  static void report(const char* name, const Act& act) {
    std::vector<double> ms;
    for (int i = 0; i < kTimes; ++i) {
      const auto from = std::chrono::steady_clock::now();
      act();
      ms.push_back(
          std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - from)
              .count());
    }
    std::ranges::sort(ms);
    const double p99 = ms[(ms.size() * 99 - 1) / 100];
    std::printf("%-34s p50 %6.1f ms  p99 %6.1f ms\n", name, ms[ms.size() / 2], p99);
    RecordProperty(name, std::to_string(p99));
  }

 private:
  std::mt19937 random_{1};
};

TEST_F(RunListLoadTest, ListsSearchesAndSortsTwentyThousandRuns) {
  const char* const kept = std::getenv("TAUTLINE_FILL");
  const std::string file = kept != nullptr ? kept : path;
  fill(file);
  db::RunReader reader(file);
  EXPECT_EQ(reader.count({}), kRuns);
  EXPECT_EQ(reader.count({.words = {"wet", "wheel"}}), kRuns / 40);
  const RunOrder by_time{.by = "time"};
  const RunOrder by_clearance{.by = "min_clearance", .descending = false};
  const RunFilter rare{.words = {"floor", "39"}};
  report("first page", [&] { reader.list({}, 50); });
  report("first page in batches", [&] { reader.list({}, 50, {}, {.grouped = true}); });
  report("search of a rare word", [&] { reader.list(rare, 50); });
  report("search of three words", [&] { reader.list({.words = {"case", "modi", "1"}}, 50); });
  report("search in batches", [&] { reader.list(rare, 50, {}, {.grouped = true}); });
  report("by time", [&] { reader.list({}, 50, {}, by_time); });
  report("by clearance, stuck ones",
         [&] { reader.list({.result = "stuck"}, 50, {}, by_clearance); });
  report("a page in the middle, by time", [&] { reader.list({}, 50, "10000:70", by_time); });
  report("counts by result", [&] { reader.results({}); });
  report("counts of a search", [&] { reader.results({.words = {"case"}}); });
  report("number of lines", [&] { reader.count({}, true); });
}

}  // namespace
