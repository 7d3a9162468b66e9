// tests/server/run/pacer_test.cpp: deadlines on a simulated clock, and real waiting.
#include "server/run/pacer.hpp"

#include <algorithm>
#include <cstdint>
#include <thread>

#include <gtest/gtest.h>

namespace server {
namespace {

using namespace std::chrono_literals;
using Clock = Deadlines::Clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

TEST(Deadlines, LatenessOfOnePeriodDoesNotDelayTheNext) {
  Deadlines deadlines;
  const Clock::time_point start{1s};
  EXPECT_EQ(deadlines.next(start, 26ms), start + 26ms);
  EXPECT_EQ(deadlines.next(start + 40ms, 26ms), start + 52ms);  // 14 ms late
  EXPECT_EQ(deadlines.next(start + 53ms, 26ms), start + 78ms);
}

TEST(Deadlines, MissedPeriodsAreCountedAndLeftOut) {
  Deadlines deadlines;
  const Clock::time_point start{1s};
  deadlines.next(start, 26ms);
  // Woken at 100 ms for 26 ms: of 52, 78 and 104 ms, 52 is missed; 78 is only late.
  EXPECT_EQ(deadlines.next(start + 100ms, 26ms), start + 78ms);
  EXPECT_EQ(deadlines.missed(), 1u);
  EXPECT_EQ(deadlines.next(start + 101ms, 26ms), start + 104ms);
  EXPECT_EQ(deadlines.missed(), 1u);
}

TEST(Deadlines, AStallIsNotFollowedByABurst) {
  for (const Clock::duration stall : {30ms, 60ms, 200ms, 499ms, 600ms, 60000ms}) {
    Deadlines deadlines;
    const Clock::time_point start{1s};
    Clock::time_point now = deadlines.next(start, 26ms) + stall;
    int at_once = 0;
    for (int i = 0; i < 10; ++i) {
      const Clock::time_point deadline = deadlines.next(now, 26ms);
      EXPECT_EQ((deadline - start) % 26ms, 0ms) << "out of step";
      EXPECT_LT(now - deadline, 26ms);
      if (deadline <= now) ++at_once;
      now = std::max(now, deadline);
    }
    EXPECT_LE(at_once, 1);
    EXPECT_EQ(deadlines.missed() + 11, static_cast<std::uint64_t>((now - start) / 26ms));
  }
}

TEST(Deadlines, WakingLateByLessThanAPeriodKeepsTheAskedSpeed) {
  Deadlines deadlines;
  const Clock::time_point start{1s};
  Clock::time_point deadline{};
  Clock::time_point now = start;
  for (int i = 0; i < 1000; ++i) {  // 8 times real time, every third wake-up 3 ms late
    deadline = deadlines.next(now, 3250us);
    now = std::max(now, deadline) + (i % 3 == 0 ? 3000us : 100us);
  }
  EXPECT_EQ(deadline, start + 1000 * 3250us);
  EXPECT_EQ(deadlines.missed(), 0u);
}

TEST(Deadlines, ARestartAndEmptyPeriodsMissNothing) {
  Deadlines deadlines;
  const Clock::time_point start{1s};
  deadlines.next(start, 26ms);
  deadlines.restart();
  EXPECT_EQ(deadlines.next(start + 10s, 26ms), start + 10s + 26ms);
  EXPECT_EQ(deadlines.next(start + 11s, 0ms), start + 10s + 26ms);  // a log may say so
  EXPECT_EQ(deadlines.missed(), 0u);
}

TEST(Pacer, RealTimeTakesRealTime) {
  Pacer pacer;
  const auto start = Clock::now();
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(pacer.wait(0.01));
  EXPECT_GE(seconds_since(start), 0.1);
}

TEST(Pacer, CountsPeriodsThatACallerSleptThrough) {
  Pacer pacer;
  EXPECT_TRUE(pacer.wait(0.01));
  std::this_thread::sleep_for(100ms);
  EXPECT_TRUE(pacer.wait(0.01));
  EXPECT_GE(pacer.missed(), 8u);
}

TEST(Pacer, SpeedDividesAndZeroDoesNotWait) {
  Pacer pacer;
  pacer.set({.speed = 10});
  auto start = Clock::now();
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(pacer.wait(0.1));
  EXPECT_GE(seconds_since(start), 0.1);
  EXPECT_LT(seconds_since(start), 0.6);
  pacer.set({.speed = 0});
  start = Clock::now();
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(pacer.wait(10));
  EXPECT_LT(seconds_since(start), 1);
}

TEST(Pacer, NoPeriodPassesWhilePausedAndSingleStepsAddUp) {
  Pacer pacer;
  pacer.set({.paused = true});
  const Clock::time_point now = Clock::now();
  EXPECT_FALSE(pacer.due(10, now));
  EXPECT_FALSE(pacer.pass(10, now));
  pacer.set({.paused = true, .single_steps = 1});
  pacer.set({.paused = true, .single_steps = 2});
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(pacer.pass(10, now));
  EXPECT_FALSE(pacer.pass(10, now));
  pacer.set({.paused = true, .single_steps = 5});
  pacer.set({.paused = true});  // a plain pause cancels the remaining steps
  EXPECT_FALSE(pacer.pass(10, now));
}

TEST(Pacer, AskingTwiceBeginsOnePeriodAndLatenessIsCounted) {
  Pacer pacer;
  const Clock::time_point start{1s};
  EXPECT_EQ(pacer.due(0.025, start), start + 25ms);
  EXPECT_EQ(pacer.due(0.025, start + 10ms), start + 25ms);
  EXPECT_FALSE(pacer.pass(0.025, start + 24ms));
  EXPECT_TRUE(pacer.pass(0.025, start + 28ms));
  EXPECT_EQ(pacer.due(0.025, start + 28ms), start + 50ms);
  EXPECT_EQ(pacer.lateness().ticks(), 1U);
  EXPECT_NEAR(pacer.lateness().worst(), 0.003, 1e-9);
  pacer.set({.speed = 0});
  EXPECT_EQ(pacer.due(0.025, start + 28ms), Clock::time_point::min());
}

TEST(Pacer, AChangeOfPaceOrStopWakesTheWaiter) {
  Pacer pacer({.paused = true});
  std::stop_source stop;
  const auto start = Clock::now();
  std::jthread other([&] {
    std::this_thread::sleep_for(20ms);
    pacer.set({.speed = 0});
  });
  EXPECT_TRUE(pacer.wait(100));  // would last 100 s
  other.join();
  pacer.set({.paused = true});
  stop.request_stop();
  EXPECT_FALSE(pacer.wait(100, stop.get_token()));
  EXPECT_LT(seconds_since(start), 10);
}

}  // namespace
}  // namespace server
