// tests/drivers/real_time_test.cpp: the real-time requests of a thread.
#include "drivers/real_time.hpp"

#include <thread>

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>
#include <sys/prctl.h>

namespace drivers {
namespace {

TEST(RealTime, TimersHaveNoSlackAfterTheRequest) {
  std::thread([] {
    // A thread with real-time priority has no slack to set. A robot may have given it to the tests.
    const sched_param normal{};
    ASSERT_EQ(::pthread_setschedparam(::pthread_self(), SCHED_OTHER, &normal), 0);
    ASSERT_EQ(::prctl(PR_SET_TIMERSLACK, 50'000, 0, 0, 0), 0);
    ask_for_punctual_timers();
    EXPECT_EQ(::prctl(PR_GET_TIMERSLACK, 0, 0, 0, 0), 1);
  }).join();
}

}  // namespace
}  // namespace drivers
