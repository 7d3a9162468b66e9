// tests/server/serve/scheduler_test.cpp: deadlines before fast tasks, fair shares, and removal.
#include "server/serve/scheduler.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "tests/server/serve/net_client.hpp"
#include <gtest/gtest.h>

#include "server/run/scenario_library.hpp"
#include "server/serve/session.hpp"

namespace server {
namespace {

using namespace std::chrono_literals;
using Clock = Run::Clock;
using net::test::eventually;
using When = Run::Next::When;

/// Counts its advances, and detects two threads at once.
class Counter final : public Scheduler::Task {
 public:
  explicit Counter(std::function<Run::Next()> then) : then_(std::move(then)) {}
  Run::Next advance() override {
    EXPECT_FALSE(busy_.exchange(true));
    ++count;
    const Run::Next next = then_();
    busy_ = false;
    return next;
  }
  std::atomic<int> count{0};

 private:
  std::function<Run::Next()> then_;
  std::atomic<bool> busy_{false};
};

Run::Next in(Clock::duration span) {
  return {.when = When::At, .time = Clock::now() + span};
}
void spin(Clock::duration span) {
  for (const auto end = Clock::now() + span; Clock::now() < end;) {
  }
}

TEST(Scheduler, AdvancesATaskAtItsTimeUntilItEnds) {
  Scheduler scheduler(2);
  std::atomic<int> left{20};
  const auto start = Clock::now();
  Counter task([&] { return --left > 0 ? in(1ms) : Run::Next{.when = When::Over}; });
  scheduler.add(task);
  EXPECT_TRUE(eventually([&] { return left == 0; }));
  EXPECT_GE(Clock::now() - start, 19ms);
  std::this_thread::sleep_for(20ms);
  EXPECT_EQ(task.count, 20);
  scheduler.remove(task);  // although it has ended by itself
}

TEST(Scheduler, WakingDoesNotWaitForTheTime) {
  Scheduler scheduler(1);
  Counter task([] { return in(1h); });
  scheduler.add(task);
  EXPECT_TRUE(eventually([&] { return task.count == 1; }));
  scheduler.wake(task);
  EXPECT_TRUE(eventually([&] { return task.count == 2; }));
  scheduler.remove(task);
}

TEST(Scheduler, ATaskThatIsWokenWhileItRunsRunsOnceMore) {
  Scheduler scheduler(1);
  std::atomic<bool> inside{false};
  std::atomic<bool> go_on{false};
  Counter task([&] {
    inside = true;
    while (!go_on) std::this_thread::yield();
    return in(1h);
  });
  scheduler.add(task);
  EXPECT_TRUE(eventually([&] { return inside.load(); }));
  scheduler.wake(task);
  go_on = true;
  EXPECT_TRUE(eventually([&] { return task.count == 2; }));
  scheduler.remove(task);
}

TEST(Scheduler, RemovingWaitsForTheRunningThreadAndNoneEntersAfter) {
  Scheduler scheduler(2);
  for (int i = 0; i < 200; ++i) {
    auto task = std::make_unique<Counter>([] {
      spin(20us);
      return Run::Next{};
    });
    scheduler.add(*task);
    std::this_thread::sleep_for(std::chrono::microseconds(i));
    scheduler.wake(*task);
    scheduler.remove(*task);
    const int count = task->count;
    std::this_thread::yield();
    EXPECT_EQ(task->count, count);
  }
}

TEST(Scheduler, FastTasksShareFairlyAndDelayNoDeadline) {
  Scheduler scheduler(1);
  std::array<std::unique_ptr<Counter>, 4> fast{};
  for (auto& task : fast) {
    task = std::make_unique<Counter>([] {
      spin(200us);
      return Run::Next{};
    });
    scheduler.add(*task);
  }
  int left = 60;
  Counter timed([&] { return --left > 0 ? in(2ms) : Run::Next{.when = When::Over}; });
  scheduler.add(timed);
  EXPECT_TRUE(eventually([&] { return timed.count == 60; }));
  const auto counts = [&] {
    std::array<int, 4> out{};
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = fast[i]->count;
    return out;
  };
  EXPECT_TRUE(eventually([&] { return std::ranges::min(counts()) > 100; }));
  for (auto& task : fast) scheduler.remove(*task);
  EXPECT_LT(std::ranges::max(counts()), 3 * std::ranges::min(counts()));
}

/// Prints how late the ticks of twenty worlds are; the wall clock does not decide the test.
TEST(Scheduler, TwentyRealTimeWorldsAllAdvance) {
  Scheduler scheduler;
  const RunHouse house{.scheduler = scheduler, .frames = std::make_shared<FrameRoom>(1024)};
  std::vector<std::unique_ptr<Session>> sessions;
  for (int i = 0; i < 20; ++i) {
    sessions.push_back(std::make_unique<Session>(house));
    sessions.back()->load(make_spec(ScenarioLibrary({}, {}).load("case1"), {}));
  }
  std::uint64_t ticks = 0;
  for (const auto end = Clock::now() + 1s; Clock::now() < end;) {
    for (auto& session : sessions) session->poll();
    std::this_thread::sleep_for(4ms);
  }
  std::array<std::uint64_t, algo::LatenessHistogram::kBuckets> late{};
  for (auto& session : sessions) {
    ASSERT_TRUE(session->newest());
    EXPECT_GT(session->newest()->telemetry.tick, 0U);
    const algo::LatenessHistogram lateness = session->lateness();
    ticks += lateness.ticks();
    for (std::size_t i = 0; i < late.size(); ++i) late[i] += lateness.counts()[i];
  }
  std::uint64_t in_time = 0;  // within 10 ms, less than half a tick of 27 ms
  for (std::size_t i = 0; i + 2 < late.size(); ++i) in_time += late[i];
  RecordProperty("ticks", static_cast<int>(ticks));
  RecordProperty("within_10_ms", static_cast<int>(in_time));
  std::printf("20 worlds: %.2f %% of %d ticks within 10 ms\n",
              100.0 * static_cast<double>(in_time) / static_cast<double>(ticks),
              static_cast<int>(ticks));
  EXPECT_GT(ticks, 0U);
}

}  // namespace
}  // namespace server
