// tests/sim/pacer_test.cpp: deadlines on a clock that is a variable, and the waiting itself.
#include "sim/pacer.hpp"

#include <thread>

#include <gtest/gtest.h>

namespace sim {
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

TEST(Deadlines, AStallIsNotCaughtUp) {
  Deadlines deadlines;
  const Clock::time_point start{1s};
  deadlines.next(start, 26ms);
  const Clock::time_point late = start + 26ms + 600ms;
  EXPECT_EQ(deadlines.next(late, 26ms), late + 26ms);
  deadlines.restart();
  EXPECT_EQ(deadlines.next(late + 5ms, 26ms), late + 31ms);
}

TEST(Pacer, RealTimeTakesRealTime) {
  Pacer pacer;
  const auto start = Clock::now();
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(pacer.wait(0.01));
  EXPECT_GE(seconds_since(start), 0.1);
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

TEST(Pacer, PausedReturnsFalseSoonAndSingleStepsAddUp) {
  Pacer pacer;
  pacer.set({.paused = true});
  const auto start = Clock::now();
  EXPECT_FALSE(pacer.wait(10));
  EXPECT_LT(seconds_since(start), 1);
  pacer.set({.paused = true, .single_steps = 1});
  pacer.set({.paused = true, .single_steps = 2});
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(pacer.wait(10));
  EXPECT_FALSE(pacer.wait(10));
  pacer.set({.paused = true, .single_steps = 5});
  pacer.set({.paused = true});  // a plain pause cancels what is left
  EXPECT_FALSE(pacer.wait(10));
}

TEST(Pacer, AChangeOfPaceWakesTheWaiter) {
  Pacer pacer;
  const auto start = Clock::now();
  std::jthread other([&] {
    std::this_thread::sleep_for(20ms);
    pacer.set({.paused = true});
  });
  EXPECT_FALSE(pacer.wait(100));  // would last 100 s
  EXPECT_LT(seconds_since(start), 10);
}

}  // namespace
}  // namespace sim
