// tests/server/experiment/pool_test.cpp: each job once, shards, and early ends of a pool.
#include "server/experiment/pool.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <numeric>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace server::experiment {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(Pool, EachJobIsDoneOnceWhateverTheThreads) {
  for (const unsigned threads : {0U, 1U, 2U, 7U}) {
    for (const std::size_t count : {0U, 1U, 5U, 100U}) {
      std::vector<std::atomic<int>> done(count);
      for_each(count, {.threads = threads}, [&](std::size_t i, const auto&) { ++done[i]; });
      for (const std::atomic<int>& times : done) EXPECT_EQ(times, 1);
    }
  }
}

TEST(Pool, ShardsShareTheJobsOutWithoutGapOrOverlap) {
  for (std::size_t count = 0; count <= 20; ++count) {
    for (std::size_t shards = 1; shards <= 6; ++shards) {
      std::vector<std::atomic<int>> done(count);
      std::size_t shares = 0;
      for (std::size_t index = 0; index < shards; ++index) {
        const Shard shard{.index = index, .count = shards};
        shares += shard.share(count);
        for_each(count, {.threads = 2, .shard = shard}, [&](std::size_t i, const auto&) {
          EXPECT_EQ(i % shards, index);
          ++done[i];
        });
      }
      EXPECT_EQ(shares, count);
      EXPECT_TRUE(std::ranges::all_of(done, [](const auto& times) { return times == 1; }));
    }
  }
}

TEST(Pool, AShardIsWrittenAsAFraction) {
  EXPECT_EQ(shard_from_text("0/1").count, 1U);
  EXPECT_EQ(shard_from_text("11/12").index, 11U);
  for (const char* wrong : {"", "1", "/", "1/", "/2", "2/2", "3/2", "0/0", "-1/2", "0/2x", "a/b"}) {
    EXPECT_THROW(shard_from_text(wrong), std::invalid_argument) << wrong;
  }
}

TEST(Pool, ProgressCountsEachJobOnce) {
  std::vector<std::size_t> seen;
  const PoolOptions options{.threads = 3, .progress = [&](std::size_t done, std::size_t all) {
                              EXPECT_EQ(all, 50U);
                              seen.push_back(done);
                            }};
  for_each(50, options, [](std::size_t, const auto&) {});
  std::vector<std::size_t> wanted(50);
  std::iota(wanted.begin(), wanted.end(), 1U);
  EXPECT_EQ(seen, wanted);
}

TEST(Pool, TheFirstFailureEndsTheOthersAndIsThrown) {
  std::atomic<int> begun{0};
  const auto job = [&](std::size_t i, const std::stop_token& stop) {
    ++begun;
    if (i == 0) throw std::runtime_error("job 0 broke");
    while (!stop.stop_requested()) std::this_thread::yield();  // hangs without a stop request
  };
  EXPECT_THAT([&] { for_each(100, {.threads = 3}, job); },
              ThrowsMessage<std::runtime_error>("job 0 broke"));
  EXPECT_LE(begun, 3);
}

TEST(Pool, IsStoppedByTheCaller) {
  std::stop_source source;
  std::atomic<int> begun{0};
  for_each(100, {.threads = 2, .stop = source.get_token()}, [&](std::size_t, const auto& stop) {
    if (++begun == 2) source.request_stop();
    while (!stop.stop_requested()) std::this_thread::yield();
  });
  EXPECT_EQ(begun, 2);
}

/// As in the server's queue, jobs arrive while others run.
TEST(Pool, ASourceMayWaitForItsJobs) {
  std::mutex mutex;
  std::condition_variable_any wake;
  std::deque<int> waiting;
  std::atomic<int> sum{0};
  Pool pool(2, [&](const std::stop_token& stop) -> Pool::Job {
    std::unique_lock lock(mutex);
    if (!wake.wait(lock, stop, [&] { return !waiting.empty(); })) return {};
    const int next = waiting.front();
    waiting.pop_front();
    return [&sum, next] { sum += next; };
  });
  for (int i = 1; i <= 100; ++i) {
    const std::lock_guard lock(mutex);
    waiting.push_back(i);
    wake.notify_one();
  }
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (sum < 5050 && std::chrono::steady_clock::now() < until) std::this_thread::yield();
  EXPECT_EQ(sum, 5050);
  pool.request_stop();
  pool.join();  // the waiting workers end
}

}  // namespace
}  // namespace server::experiment
