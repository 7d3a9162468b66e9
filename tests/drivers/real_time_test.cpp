// tests/drivers/real_time_test.cpp: the real-time requests of a thread.
#include "drivers/real_time.hpp"

#include <thread>

#include <gtest/gtest.h>
#include <sys/prctl.h>

namespace drivers {
namespace {

TEST(RealTime, TimersHaveNoSlackAfterTheRequest) {
  std::thread([] {
    ASSERT_EQ(::prctl(PR_SET_TIMERSLACK, 50'000, 0, 0, 0), 0);
    ask_for_punctual_timers();
    EXPECT_EQ(::prctl(PR_GET_TIMERSLACK, 0, 0, 0, 0), 1);
  }).join();
}

}  // namespace
}  // namespace drivers
